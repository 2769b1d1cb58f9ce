// Clicks in the 3D view place the frame in hand: on a joint axis for z (a second click turns it over), on a dot for the
// origin, on the end of an arrow for x. The cells do the same by keyboard.

import { h } from "../../shared/dom.js";
import { directionText, nearestAxes } from "./axis_words.js";
import { FINGER, Marks } from "./marks.js";
import { Offers } from "./offers.js";
import { along } from "./place_choices.js";
import { worded } from "../../shared/words/words.js";

/** @type {Front.FrameStep} */
const Z = "z";
/** @type {Front.FrameCell[]} */
const ORIGIN = ["origin_x", "origin_y", "origin_z"];
/** @type {Record<Front.FrameStep, (frame: string) => string>} */
const HINTS = {
  z: (frame) => worded("Frame {frame}: click a joint axis, so that z lies along it.", { frame }),
  origin: (frame) =>
    worded("Frame {frame}: click a dot for the origin, or the end of the arrow to turn z over.", { frame }),
  x: (frame) =>
    worded("Frame {frame}: click the end of an arrow for x, or its dot to choose another origin.", { frame }),
};
const ALL_PLACED = worded("All frames are placed. To change one by clicks, first select one of its cells.");
// The length of the longest arrow for x, in pixels: long enough for fingers to hit only one end.
const ARROW = 72;
// The end of the arrow for z moves along the arrow, until it is a finger's width away from all dots. It moves at most
// this number of steps; each step is an eighth of a finger's width.
const FAR = 80;
// A pointer that has moved farther than this, in pixels, has turned the view and has not clicked.
const STILL = 4;

export class FrameClicks {
  // The frame and the step that the student or the last click has chosen; null for the first incomplete frame.
  /** @type {{ row: Front.RowView, step: Front.FrameStep } | null} */
  #chosen = null;
  #stop = new AbortController();

  /**
   * `part` has the cells of the frames, `scene` draws the axes.
   *
   * @param {Front.ViewHost} host
   * @param {Front.PartView} part
   * @param {Front.RobotScene} scene
   * @param {() => Front.ShownValues} shown the values of symbols and joints in the view
   */
  constructor(host, part, scene, shown) {
    this.host = host;
    this.part = part;
    this.scene = scene;
    this.marks = new Marks(scene.stage);
    this.offers = new Offers(host, part, shown, () => this.#draw());
    this.hint = h("p", { class: "quiet frame-hint" });
    scene.drawn = () => this.#draw();
    const { signal } = this.#stop;
    let from = [0, 0];
    scene.canvas.addEventListener("pointerdown", ({ clientX, clientY }) => (from = [clientX, clientY]), {
      signal,
      capture: true,
    });
    scene.canvas.addEventListener("click", ({ clientX, clientY, offsetX, offsetY }) => {
      if (Math.hypot(clientX - from[0], clientY - from[1]) <= STILL) this.#clicked([offsetX, offsetY]);
    }, { signal });
    part.element.addEventListener("focusin", ({ target }) => this.#focused(target), { signal });
    const { activeElement } = /** @type {ShadowRoot} */ (part.element.getRootNode());
    this.#focused(activeElement);
  }

  /** @param {EventTarget | null} target */
  #focused(target) {
    for (const row of this.part.rows) {
      const own = row.cells.find(({ input }) => input === target);
      if (own) this.#chosen = { row, step: stepOf(own.place.label) };
    }
    this.#draw();
  }

  /** The current frame and its step: those of the student's last cell, or else of the first empty cell. z is first. */
  get #hand() {
    const hand = this.#chosen ?? this.#firstEmpty;
    return hand && !this.#joints.includes(textOf(hand.row, "axis")) ? { row: hand.row, step: Z } : hand;
  }

  get #firstEmpty() {
    for (const row of this.part.rows) {
      const empty = row.cells.find(({ text }) => !text.trim());
      if (empty) return { row, step: stepOf(empty.place.label) };
    }
    return null;
  }

  /** @param {number[]} at pixels from the upper left corner of the stage */
  #clicked(at) {
    const mark = this.marks.nearest(at);
    if (mark) return this.#choose(mark);
    const found = nearestAxes(at, this.scene.axesOnStage());
    // If the frame of the last cell is complete, a click on an axis begins the next frame.
    const isDone = this.#chosen?.step === "x" && this.#chosen.row.cells.every(({ text }) => text.trim());
    const hand = (isDone && this.#firstEmpty) || this.#hand;
    return found.length && hand && isOpen(hand.row) ? this.#alongAxis(hand.row, found) : undefined;
  }

  /** @param {Front.RowView} row @param {number[]} found the joints whose axes were clicked */
  async #alongAxis(row, found) {
    const names = found.map((i) => this.#joints[i]);
    const used = this.part.rows.map((each) => textOf(each, "axis"));
    const own = textOf(row, "axis");
    // If several joints are on this line, the frame keeps its own joint, or else gets a joint that has no frame.
    const joint = names.find((name) => name === own) ?? names.find((name) => !used.includes(name)) ?? names[0];
    const home = await this.offers.home().catch(() => null);
    if (!home) return this.host.announce(worded("The directions of the axes could not be loaded"));
    const [text, opposite] = [1, -1].map((sign) => this.offers.axisText(this.#joints.indexOf(joint), sign));
    const isAgain = joint === own && textOf(row, "z") === text;
    const z = isAgain ? opposite : text;
    this.#chosen = { row, step: "origin" };
    this.#write(row, [["axis", joint], ["z", z]]);
    this.host.announce(toldZ(row, joint, z));
  }

  /** @param {Front.PlaceMark} mark */
  #choose({ texts, told, isChosen }) {
    const hand = this.#hand;
    if (!hand || !isOpen(hand.row)) return;
    const { row, step } = hand;
    const [[label]] = texts;
    // In step x, a click on the chosen origin leads back to the origin. After x, the first incomplete frame follows.
    const next = label === "z" || (isChosen && step === "x") ? "origin" : "x";
    this.#chosen = label === "x" ? null : { row, step: next };
    this.#write(row, isChosen ? [] : texts);
    if (!isChosen) this.host.announce(told);
  }

  /** @param {Front.RowView} row @param {[Front.FrameCell, string][]} texts */
  #write(row, texts) {
    if (texts.length) this.part.write(texts.map(([label, text]) => [cell(row, label), text]));
    this.#draw();
  }

  #draw() {
    const hand = this.#hand;
    this.hint.hidden = Boolean(hand && !isOpen(hand.row));
    this.hint.textContent = hand ? HINTS[hand.step](hand.row.label) : ALL_PLACED;
    if (!hand || !isOpen(hand.row)) return this.marks.show([], []);
    const { row, step } = hand;
    const axes = this.scene.axesOnStage().map((ends, i) => ({ ends, joint: this.#joints[i] }));
    const own = textOf(row, "axis");
    this.marks.show(
      step === "z" ? [] : this.#offered(row, step),
      axes.filter(({ joint }) => step === "z" || (step === "origin" && joint === own)),
    );
    return undefined;
  }

  get #joints() {
    const { shape } = this.part.part;
    return "joints" in shape ? shape.joints : [];
  }

  /**
   * Return the dots or the arrows that are offered for a frame.
   *
   * @param {Front.RowView} row
   * @param {Front.FrameStep} step
   * @returns {Front.PlaceMark[]}
   */
  #offered(row, step) {
    const { mechanism, size } = this.scene.robot;
    const joint = textOf(row, "axis");
    const offers = this.offers.of(this.part.rows.indexOf(row), joint, mechanism);
    if (!mechanism || !offers) return [];
    const frame = row.label;
    const written = ORIGIN.map((label) => textOf(row, label)).join();
    const dots = offers.origins.map(({ texts, point }) => ({
      point,
      at: this.scene.onStage(point),
      texts: zipped(ORIGIN, texts),
      isChosen: texts.join() === written,
      told: worded("Frame {frame}: origin at ({x}, {y}, {z})", { frame, x: texts[0], y: texts[1], z: texts[2] }),
    }));
    if (step === "origin") return [...dots, ...this.#turnedOver(row, dots.map(({ at }) => at))];
    const origin = dots.find(({ isChosen }) => isChosen);
    // If the written origin is not among the dots, the arrows are at the joint.
    const point = origin?.point ?? mechanism.centres[this.#joints.indexOf(joint)];
    if (!point) return [];
    const from = this.scene.onStage(point);
    const ends = (/** @type {number} */ length) =>
      offers.directions.map(({ shown }) => this.scene.onStage(along(point, shown, length)));
    const trial = size / 10;
    const longest = Math.max(1, ...ends(trial).map(([x, y]) => Math.hypot(x - from[0], y - from[1])));
    const places = ends((trial * ARROW) / longest);
    const arrows = offers.directions.map(({ vector }, i) => {
      const text = directionText(vector);
      return {
        at: places[i],
        from,
        texts: zipped(["x"], [text]),
        isChosen: textOf(row, "x") === text,
        told: worded("Frame {frame}: x along {direction}", { frame, direction: text }),
      };
    });
    return [...(origin ? [origin] : []), ...arrows];
  }

  /**
   * Return the arrow for z if z lies along the joint axis. A click on the end of the arrow reverses z.
   *
   * @param {Front.RowView} row
   * @param {number[][]} dots
   * @returns {Front.PlaceMark[]}
   */
  #turnedOver(row, dots) {
    const joint = textOf(row, "axis");
    const i = this.#joints.indexOf(joint);
    const { mechanism, size } = this.scene.robot;
    const sign = [1, -1].find((each) => textOf(row, "z") === this.offers.axisText(i, each));
    if (!mechanism || i < 0 || !sign) return [];
    const from = this.scene.onStage(mechanism.centres[i]);
    const tip = this.scene.onStage(along(mechanism.centres[i], mechanism.axes[i], (sign * size) / 10));
    const step = along(tip, from, -1);
    const length = Math.hypot(...step);
    // An axis in the viewing direction has no length in the picture.
    if (length < 2) return [];
    const isFree = (/** @type {number[]} */ at) => dots.every((dot) => Math.hypot(...along(at, dot, -1)) >= FINGER);
    let at = along(from, step, FINGER / length);
    for (let i = 0; i < FAR && !isFree(at); i++) at = along(at, step, FINGER / 8 / length);
    const z = this.offers.axisText(i, -sign);
    return [{ at, from, texts: zipped(["z"], [z]), isChosen: false, told: toldZ(row, joint, z) }];
  }

  close() {
    this.#stop.abort();
    this.offers.close();
    this.marks.close();
  }
}

/** @param {Front.RowView} row @param {string} joint @param {string} direction */
const toldZ = (row, joint, direction) =>
  worded("Frame {frame}: z along the axis of joint {joint}, {direction}", { frame: row.label, joint, direction });

/** @param {Front.FrameCell[]} labels @param {string[]} texts @returns {[Front.FrameCell, string][]} */
const zipped = (labels, texts) => labels.map((label, i) => [label, texts[i]]);

/** @param {string} label @returns {Front.FrameStep} */
const stepOf = (label) => (label === "x" ? "x" : label.startsWith("origin") ? "origin" : "z");

/** @param {Front.RowView} row @param {string} label */
function cell(row, label) {
  const [found] = row.cells.filter(({ place }) => place.label === label);
  return found;
}

/** @param {Front.RowView} row @param {string} label */
const textOf = (row, label) => cell(row, label).text.trim();

/** True if the student may change the cells of a row. @param {Front.RowView} row */
const isOpen = (row) => !cell(row, "axis").input.matches(":disabled, :read-only");
