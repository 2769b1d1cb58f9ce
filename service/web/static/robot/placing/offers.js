// The origins and directions that are offered for a frame, and where they are in the picture.

import { directionText } from "./axis_words.js";
import { along, isSame, namedPoints, sumOf, sumText, xDirections } from "./place_choices.js";

// How long the joints must rest before the service is asked for the places, in milliseconds.
const REST = 200;

export class Offers {
  /** @type {Promise<Front.HomeOffers> | null} */
  #loading = null;
  /** @type {Front.HomeOffers | null} */
  #home = null;
  /** @type {Front.LinkMotions | null} */
  #moved = null;
  #asked = "";
  #timer = 0;

  /**
   * `shown` returns the values of symbols and joints in the view, `draw` is called when there are other places.
   *
   * @param {Front.ViewHost} host
   * @param {Front.PartView} part
   * @param {() => Front.ShownValues} shown
   * @param {() => void} draw
   */
  constructor(host, part, shown, draw) {
    this.host = host;
    this.part = part;
    this.shown = shown;
    this.draw = draw;
  }

  get #joints() {
    const { shape } = this.part.part;
    return "joints" in shape ? shape.joints : [];
  }

  /** Load the directions of the joint axes with all joint variables 0, and the offers. */
  home() {
    this.#loading ??= this.#atHome().then((home) => (this.#home = home));
    this.#loading.catch(() => (this.#loading = null));
    return this.#loading;
  }

  /**
   * Return the direction of a joint axis, or the opposite one, as a text; empty until it is loaded.
   *
   * @param {number} i
   * @param {number} sign
   */
  axisText(i, sign) {
    const axis = this.#home?.axes[i];
    return axis ? directionText(axis.map((value) => sign * value)) : "";
  }

  /**
   * Return the offers for a row in the picture, or null until the service has told where they are there.
   *
   * @param {number} row
   * @param {string} axis the joint of its z axis
   * @param {Api.DrawnConfiguration | null} picture
   */
  of(row, axis, picture) {
    if (!picture) return null;
    const key = JSON.stringify(this.shown());
    if (key !== this.#asked) this.#later(key);
    const [home, moved] = [this.#home, this.#moved];
    const isThere = (/** @type {"centres" | "axes"} */ name) =>
      moved?.picture[name].every((each, i) => isSame(each, picture[name][i] ?? []));
    if (!home || !moved || !isThere("centres") || !isThere("axes")) return null;
    const motion = moved.motions[row];
    const turned = (/** @type {number[]} */ vector) =>
      motion.slice(0, 3).map((line) => line[0] * vector[0] + line[1] * vector[1] + line[2] * vector[2]);
    const values = home.names.map((name) => moved.symbols[name]);
    const joint = this.#joints.indexOf(axis);
    return {
      origins: [...home.places, ...(home.slid[joint] ?? [])].map(({ texts, sums }) => {
        const point = sums.map((sum) => sum.reduce((total, factor, i) => total + factor * values[i], 0));
        return { texts, point: turned(point).map((value, i) => value + motion[i][3]) };
      }),
      directions: (home.directions[joint] ?? []).map((vector) => ({ vector, shown: turned(vector) })),
    };
  }

  /** @param {string} key */
  #later(key) {
    clearTimeout(this.#timer);
    this.#asked = key;
    this.#timer = setTimeout(async () => {
      try {
        const [moved] = await Promise.all([this.#atValues(), this.home()]);
        if (key !== this.#asked) return;
        this.#moved = moved;
        this.draw();
      } catch {
        // The next picture asks again.
        if (key === this.#asked) this.#asked = "";
      }
    }, REST);
  }

  /** Frames in the place of the base frame move with their links: they tell how the links have moved. */
  async #atValues() {
    const { exercise } = this.host.body() ?? {};
    const { symbols, joints } = this.shown();
    const rows = this.part.rows.map(() => ({ axis: this.#joints[0], z: "+z", origin: [0, 0, 0], x: "+x" }));
    const placed = { part: this.part.part.id, rows };
    const answer = await this.host.service.frames({ exercise, symbols, joints: [joints], placed });
    const picture = answer.mechanism?.configurations[0] ?? { centres: [], axes: [] };
    return { picture, symbols: answer.symbols, motions: answer.placed?.frames[0] ?? [] };
  }

  /** Ask for the robot twice: a point that is the same sum of symbols in both, and a direction, has a name. */
  async #atHome() {
    const { exercise } = this.host.body() ?? {};
    const joints = [this.#joints.map(() => 0)];
    const one = await this.host.service.frames({ exercise, joints });
    const names = Object.keys(one.symbols);
    // Values without a relation tell a point as a sum.
    const values = Object.values(one.symbols).map((value, i) => value + 0.1 * (value || 1) * Math.sin(i + 1));
    const symbols = Object.fromEntries(names.map((name, i) => [name, values[i]]));
    const other = await this.host.service.frames({ exercise, joints, symbols });
    return offersOf(linesOf(one), linesOf(other), names, values, this.#joints.length);
  }

  close() {
    clearTimeout(this.#timer);
  }
}

/** @param {Api.Frames} answer */
function linesOf({ mechanism }) {
  const { centres, axes, frames } = mechanism?.configurations[0] ?? { centres: [], axes: [], frames: [] };
  return [
    ...centres.map((centre, i) => [centre, axes[i]]),
    ...frames.map((frame) => [3, 2].map((i) => frame.slice(0, 3).map((line) => line[i]))),
  ];
}

/**
 * Return the offers of a robot from its lines at two choices of the symbols.
 *
 * @param {number[][][]} one
 * @param {number[][][]} other at `values`
 * @param {string[]} names
 * @param {number[]} values
 * @param {number} joints
 * @returns {Front.HomeOffers}
 */
export function offersOf(one, other, names, values, joints) {
  /** @type {Map<string, Front.NamedPlace>} */
  const places = new Map();
  /** @param {Map<string, Front.NamedPlace>} found @param {number[]} point */
  const add = (found, point) => {
    const sums = point.flatMap((value) => {
      const sum = sumOf(value, values);
      return sum ? [sum] : [];
    });
    if (sums.length < point.length) return;
    const texts = sums.map((sum) => sumText(sum, names));
    if (!places.has(texts.join())) found.set(texts.join(), { texts, sums });
  };
  other.forEach((_, i) => namedPoints(other, i).forEach((point) => add(places, point)));
  const lengths = values.filter((_, i) => [...places.values()].some(({ sums }) => sums.some((sum) => sum[i])));
  const axes = [...Array(joints).keys()];
  return {
    axes: one.slice(0, joints).map(([, axis]) => axis),
    names,
    places: [...places.values()],
    // Places beside the named ones on each joint axis: not every place on an axis is a foot.
    slid: axes.map((i) => {
      const found = new Map();
      const foot = namedPoints(other, i).find((point) => point.every((value) => sumOf(value, values)));
      for (const sign of [1, -1]) {
        if (foot && lengths.length) add(found, along(foot, other[i][1], sign * lengths[0]));
      }
      return [...found.values()];
    }),
    directions: axes.map((i) => {
      const fixed = xDirections(other, i);
      return xDirections(one, i).filter((each) => fixed.some((vector) => isSame(vector, each)));
    }),
  };
}
