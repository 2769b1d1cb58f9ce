// The picture of a screen: the arm as SVG, and a frame that goes through the moves. It needs no WebGL.

import { h } from "../shared/dom.js";
import { Playback } from "../robot/rows/playback.js";
import { frameAt } from "../robot/rows/row_moves.js";
import { captionText, captionWithoutAmount, lowered } from "../robot/rows/row_words.js";
import { axes, corners, frames, moves, ROWS } from "./tour_robot.js";
import { worded } from "../shared/words/words.js";

const SVG = "http://www.w3.org/2000/svg";
const SCALE = 350;
const [LEFT, BOTTOM] = [90, 335];
const HEAD = 9;
const ARROW = 0.17;
const PIECES = 20;
const SMALL = 1e-9;
// The viewing direction: from the front, a little from the right and from above.
const [AZIMUTH, ELEVATION] = [-0.5, 0.36];
const RIGHT = [-Math.sin(AZIMUTH), Math.cos(AZIMUTH), 0];
const UP = [
  -Math.sin(ELEVATION) * Math.cos(AZIMUTH),
  -Math.sin(ELEVATION) * Math.sin(AZIMUTH),
  Math.cos(ELEVATION),
];
const MIDDLE = 0.5;
/** @type {Record<string, number>} */
const COLUMNS = { x: 0, y: 1, z: 2 };

/** @param {number[]} one @param {number[]} other */
const dot = (one, other) => one.reduce((sum, each, i) => sum + each * other[i], 0);
/** @param {number[]} from @param {number[]} along @param {number} by */
const gone = (from, along, by) => from.map((each, i) => each + by * along[i]);
/** @param {number[]} point */
const seen = (point) => [LEFT + SCALE * dot(point, RIGHT), BOTTOM - SCALE * dot(point, UP)];
/** @param {Front.Frame} frame @param {number} i */
const column = (frame, i) => frame.map((row) => row[i]);

/** @param {string} tag @param {Record<string, string | number>} attributes @param {string} [text] */
function s(tag, attributes, text = "") {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.textContent = text;
  return element;
}

/** @param {number[][]} points @param {string} look */
const line = (points, look) =>
  s("polyline", { class: look, points: points.map((each) => seen(each).map((n) => n.toFixed(1)).join()).join(" ") });

/** @param {number[]} point @param {string} text @param {string} look @param {[number, number]} [by] */
function label(point, text, look, [dx, dy] = [0, 0]) {
  const [x, y] = seen(point);
  return s("text", { class: look, x: (x + dx).toFixed(1), y: (y + dy).toFixed(1) }, text);
}

/** Return the head of an arrow on the drawing. @param {number[]} from @param {number[]} to @param {string} look */
function head(from, to, look) {
  const along = Math.atan2(to[1] - from[1], to[0] - from[0]);
  const points = [0, 2.5, -2.5].map((turn) => {
    const by = turn ? HEAD : HEAD / 2;
    return [to[0] + by * Math.cos(along + turn), to[1] + by * Math.sin(along + turn)].map((n) => n.toFixed(1)).join();
  });
  return s("polygon", { class: look, points: points.join(" ") });
}

/** @param {Front.Frame} frame @param {string} look @param {string} name */
function arrows(frame, look, name) {
  const origin = column(frame, 3);
  return ["x", "y", "z"].flatMap((axis) => {
    const end = gone(origin, column(frame, COLUMNS[axis]), ARROW);
    const text = gone(origin, column(frame, COLUMNS[axis]), ARROW + 0.045);
    const parts = [line([origin, end], `${look} ${axis}`), head(seen(origin), seen(end), `${look} ${axis}`)];
    if (name && axis !== "y") parts.push(label(text, `${axis}${name}`, `name ${axis}`));
    return parts;
  });
}

export class ArmPicture {
  /** @type {Api.Convention} */
  #convention = "standard";
  /** The number of the move that the caption describes. */
  #told = 0;

  /**
   * `id` is the id of the screen.
   *
   * @param {string} id
   * @param {HTMLElement} element
   */
  constructor(id, element) {
    this.id = id;
    this.caption = h("p", { class: "caption", "aria-live": "polite" });
    this.drawing = s("svg", { viewBox: "0 0 440 370", role: "img" });
    /** @type {(text: string, act: () => void) => HTMLButtonElement} */
    const button = (text, act) => h("button", { type: "button", class: "quiet-button", onclick: act }, text);
    this.run = button(worded("Play"), () => this.#run());
    this.back = button(worded("Back to the start"), () => this.#start());
    this.playback = new Playback(() => this.#moved(), () => this.#stopped());
    const buttons = ROWS[id] ? [this.run, this.back] : [];
    element.replaceChildren(this.drawing, this.caption, h("div", { class: "buttons" }, ...buttons));
  }

  get #row() {
    return ROWS[this.id]?.[this.#convention];
  }

  /** The moves that the screen plays: all four, or only the move of its parameter. @returns {[number, number]} */
  get #range() {
    if (this.id === "table") return [0, 4];
    const i = moves(this.#convention, this.#row).findIndex(({ parameter }) => parameter === this.id);
    return [i, i + 1];
  }

  /** @param {Api.Convention} convention */
  show(convention) {
    this.#convention = convention;
    this.#start();
  }

  stop() {
    this.playback.stop();
  }

  #start() {
    this.playback.stop();
    if (this.#row !== undefined) this.playback.at = this.#range[0];
    this.#draw();
    this.#tell();
  }

  #run() {
    if (this.playback.isRunning) return this.playback.stop();
    const [from, to] = this.#range;
    if (this.playback.at >= to) this.playback.at = from;
    const still = moves(this.#convention, this.#row).map(({ amount }) => Math.abs(amount) < SMALL);
    this.playback.play(to, (i) => still[i]);
    if (this.playback.isRunning) this.run.textContent = worded("Pause");
    return undefined;
  }

  /** Draw the picture, and change the caption when a move begins. */
  #moved() {
    this.#draw();
    if (this.#move !== this.#told) this.#tell();
  }

  /** The number of the current move, 0 at the start. */
  get #move() {
    return Math.ceil(this.playback.at - SMALL);
  }

  #stopped() {
    this.#draw();
    this.#tell();
  }

  /** Write the caption, which says what the picture shows. */
  #tell() {
    const [row, at] = [this.#row, this.playback.at];
    this.#told = this.#move;
    this.run.textContent = this.playback.isRunning ? worded("Pause") : worded("Play");
    if (row === undefined) {
      this.caption.textContent = worded("The blue z of a joint lies along the line about which it turns.");
    } else if (at <= this.#range[0]) {
      this.caption.textContent = at === 0
        ? worded("The moving frame (thick) starts on frame {frame}.", { frame: `{${row}}` })
        : worded("The moving frame (thick) is where the moves before have taken it.");
    } else {
      const [convention, all] = [this.#convention, moves(this.#convention, row)];
      const caption = this.id === "table" ? captionText : captionWithoutAmount;
      // Except in the last screen, the caption omits the amount of the move, because the screen asks for it.
      this.caption.textContent = caption({ row: row + 1, at, moves: all, convention, unit: "m" });
    }
    const arm = worded("An arm: a column with joint 1, link 1 to the side, joint 2, and link 2 up to the tip.");
    this.drawing.setAttribute("aria-label", `${arm} ${this.caption.textContent}`);
  }

  #draw() {
    const [convention, row] = [this.#convention, this.#row];
    const [foot, top, joint, tip] = corners();
    const all = frames(convention);
    const parts = axes().map(([point, along], i) =>
      line([gone(point, along, i ? -0.2 : -0.62), gone(point, along, i ? 0.3 : 0.36)], "axis")
    );
    parts.push(line([foot, top, joint, tip], "arm"), ...[foot, top, joint, tip].map((each) => this.#dot(each)));
    // The names of the axes are above the arm, because they are long in some languages.
    parts.push(
      ...axes().map(([point, along], i) => {
        const name = worded("axis of joint {joint}", { joint: i + 1 });
        return label(gone(point, along, i ? 0.33 : 0.4), name, "quiet-name", i ? [16, 12] : [0, 0]);
      }),
    );
    const lengths = /** @type {[string, number[], number[], [number, number]][]} */ ([
      ["h", foot, top, [-22, 0]],
      ["w", top, joint, [2, 20]],
      ["r", joint, tip, [14, 14]],
    ]);
    for (const [name, from, to, by] of lengths) {
      parts.push(label(gone(from, to.map((each, i) => each - from[i]), MIDDLE), name, "length", by));
    }
    /** @type {[string, number[], number[], [number, number], string][]} */
    const names = [
      [worded("column"), foot, top, [-14, -22], "quiet-name at-end"],
      [worded("link {link}", { link: 1 }), top, joint, [4, -18], "quiet-name"],
      [worded("link {link}", { link: 2 }), joint, tip, [9, 32], "quiet-name at-start"],
    ];
    for (const [name, from, to, by, look] of names) {
      parts.push(label(gone(from, to.map((each, i) => each - from[i]), MIDDLE), name, look, by));
    }
    const last = all.length - 1;
    const named = row === undefined ? all.map((_, i) => i) : [row, row + 1];
    for (const i of named) {
      const name = convention === "modified" && i === last ? "ₑ" : lowered(i);
      parts.push(...arrows(all[i], row !== undefined && i > row ? "goal" : "fixed", name));
    }
    if (row !== undefined) parts.push(...this.#moving(all[row], row));
    this.drawing.replaceChildren(...parts);
  }

  /** @param {number[]} point */
  #dot(point) {
    const [cx, cy] = seen(point);
    return s("circle", { class: "joint", cx: cx.toFixed(1), cy: cy.toFixed(1), r: 6 });
  }

  /** Return the moving frame, and the path of each move so far. @param {Front.Frame} start @param {number} row */
  #moving(start, row) {
    const all = moves(this.#convention, row);
    const [from] = this.#range;
    const { at } = this.playback;
    const parts = all.flatMap(({ axis, turns, amount }, i) => {
      const share = Math.max(0, Math.min(1, at - i));
      if (i < from || Math.abs(share * amount) < SMALL) return [];
      const steps = Array.from({ length: PIECES + 1 }, (_, k) => frameAt(start, all, i + (share * k) / PIECES));
      // A turn about z moves x, a turn about x moves z.
      const arm = axis === "z" ? COLUMNS.x : COLUMNS.z;
      const points = steps.map((frame) =>
        turns ? gone(column(frame, 3), column(frame, arm), 0.75 * ARROW) : column(frame, 3)
      );
      return [line(points, `way ${axis}`)];
    });
    return [...parts, ...arrows(frameAt(start, all, at), "moving", "")];
  }
}
