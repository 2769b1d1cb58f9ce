// The origins and directions that the view offers for a frame, and their positions in the picture.

import { directionText } from "./axis_words.js";
import { along, isSame, namedPoints, sumOf, sumText, xDirections } from "./place_choices.js";

// The time in milliseconds for which the joints must rest before a request for positions.
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
   * `shown` returns the values of symbols and joints in the view, `draw` is called when positions have changed.
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

  /** Load the offers, and the directions of the joint axes if all joint variables are 0. */
  home() {
    this.#loading ??= this.#atHome().then((home) => (this.#home = home));
    this.#loading.catch(() => (this.#loading = null));
    return this.#loading;
  }

  /**
   * Return the direction of a joint axis, or the opposite direction, as a text; empty until the axes are loaded.
   *
   * @param {number} i
   * @param {number} sign
   */
  axisText(i, sign) {
    const axis = this.#home?.axes[i];
    return axis ? directionText(axis.map((value) => sign * value)) : "";
  }

  /**
   * Return the offers for a row, with positions in the picture; null until the service has sent these positions.
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

  /** Request frames that lie on the base frame if all joints are 0. Their positions show how the links have moved. */
  async #atValues() {
    const { exercise } = this.host.body() ?? {};
    const { symbols, joints } = this.shown();
    const rows = this.part.rows.map(() => ({ axis: this.#joints[0], z: "+z", origin: [0, 0, 0], x: "+x" }));
    const placed = { part: this.part.part.id, rows };
    const answer = await this.host.service.frames({ exercise, symbols, joints: [joints], placed });
    const picture = answer.mechanism?.configurations[0] ?? { centres: [], axes: [] };
    return { picture, symbols: answer.symbols, motions: answer.placed?.frames[0] ?? [] };
  }

  /** Request the robot with two sets of symbol values. Places are sums of symbols, directions are the same in both. */
  async #atHome() {
    const { exercise } = this.host.body() ?? {};
    const joints = [this.#joints.map(() => 0)];
    const one = await this.host.service.frames({ exercise, joints });
    const names = Object.keys(one.symbols);
    // With values that have no simple relation, a coordinate can be only one sum of symbols.
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
 * Return the offers for a robot from its lines with two sets of symbol values.
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
    // On each joint axis, a place on either side of a named place: an origin may be anywhere on its axis.
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
