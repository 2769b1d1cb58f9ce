// The player of a row: buttons, the scrub bar and the caption. The ghost frame goes through the moves of the row.

import { h } from "../../shared/dom.js";
import { gapBetween, isClosed } from "../frames/gap.js";
import { gapSentence } from "../frames/view_text.js";
import { axisGap, jointAfter } from "./axis_gap.js";
import { Playback } from "./playback.js";
import { frameAt, movesOf } from "./row_moves.js";
import { amountText, axisText, captionText, moveText, placeText } from "./row_words.js";
import { later } from "../../shared/later.js";
import { worded } from "../../shared/words/words.js";
import { typeset } from "../../typeset/names.js";

const STYLE = new URL("./rows.css", import.meta.url).href;
const STEP = 0.05;
const MOVES = 4;
const SMALL = 1e-9;

/** @typedef {{ row: number, parameter: string }} Lit */

export class RowPlayer {
  #row = 1;
  /** @type {Lit | null} */
  #lit = null;
  /** @type {Api.Frames} */
  #answer;
  /** @type {Front.Picture} */
  #picture;
  /** @type {Api.Convention} */
  #convention = "standard";
  /** @type {Front.RowShapeClass | null} */
  #Shape = null;
  /** @type {Element | null} */
  #cell = null;

  /** @param {Front.RowHost} view @param {HTMLElement} element */
  constructor(view, element) {
    this.view = view;
    this.element = element;
    this.unit = view.host.unit ?? "m";
    this.playback = new Playback(() => this.#moved(), (isEnd) => this.#stopped(isEnd));
    this.rows = h("select", {
      "aria-label": worded("Row"),
      onchange: (event) => this.#choose(Number(event.target.value)),
    });
    this.bar = h("input", {
      type: "range",
      min: 0,
      max: MOVES,
      step: STEP,
      "aria-label": worded("Moves of the row"),
      oninput: (event) => this.#jump(Number(event.target.value)),
    });
    this.caption = h("p", { class: "caption" });
    this.told = h("p", { class: "quiet" });
    this.list = h("ol", { class: "moves", "aria-label": worded("Moves of the row") });
    /** @type {(text: string, act: () => void) => HTMLButtonElement} */
    const button = (text, act) => h("button", { type: "button", class: "quiet-button", onclick: act }, text);
    this.run = button(worded("Play"), () => this.#run());
    this.back = button(worded("Previous move"), () => this.#step(-1));
    this.next = button(worded("Next move"), () => this.#step(1));
    element.setAttribute("role", "group");
    element.setAttribute("aria-label", worded("Play a row"));
    element.replaceChildren(
      h("link", { rel: "stylesheet", href: STYLE }),
      h(
        "div",
        { class: "row-buttons" },
        h("label", {}, worded("Play row"), " ", this.rows),
        this.run,
        this.back,
        this.next,
      ),
      this.bar,
      this.caption,
      this.list,
      this.told,
    );
  }

  /** Load the parts of the scene, unless the view is a drawing. */
  async open() {
    if (this.view.isFlat()) return;
    this.#Shape = (await later(import.meta.resolve("./row_shape.js"), () => import("./row_shape.js"))).RowShape;
  }

  /** Open or close the panel, and return true if it is open. */
  toggle() {
    this.element.hidden = !this.element.hidden;
    this.playback.stop();
    this.#moved();
    this.element.scrollIntoView({ block: "nearest" });
    return !this.element.hidden;
  }

  // What is shown.

  /**
   * Show another picture or table.
   *
   * @param {Api.Frames} answer
   * @param {Front.Picture} picture
   * @param {Api.Convention} convention
   */
  show(answer, picture, convention) {
    this.#answer = answer;
    this.#picture = picture;
    this.#convention = convention;
    const count = picture.values?.length ?? 0;
    if (this.rows.options.length !== count) {
      const options = Array.from({ length: count }, (_, i) => h("option", { value: i + 1 }, String(i + 1)));
      this.rows.replaceChildren(...options);
    }
    this.#row = Math.max(1, Math.min(this.#row, count));
    this.rows.value = String(this.#row);
    if (count) this.#write();
  }

  /**
   * Highlight the length or the angle of a cell in the view; null removes the highlight.
   *
   * @param {Lit | null} lit
   */
  light(lit) {
    if (this.element.hidden) this.#lit = lit;
    else if (lit && lit.row <= (this.#picture.values?.length ?? 0)) this.#follow(lit);
    this.#draw();
  }

  /** Show the end of the move that belongs to a cell. @param {Lit} lit */
  #follow({ row, parameter }) {
    this.playback.stop();
    this.#row = row;
    this.rows.value = String(row);
    this.playback.at = this.#moves(row).findIndex((move) => move.parameter === parameter) + 1;
    this.#write();
  }

  /** @param {number} row */
  #moves(row) {
    return movesOf(this.#picture.values?.[row - 1] ?? [0, 0, 0, 0], this.#convention);
  }

  /** The index of the current move, or of the first one at the beginning. */
  get #current() {
    return Math.max(0, Math.ceil(this.playback.at - SMALL) - 1);
  }

  /**
   * Return the row to draw in a picture, or null.
   *
   * @param {Front.Picture} picture
   * @returns {Front.ShownRow | null}
   */
  shown(picture) {
    const isLit = Boolean(this.element.hidden);
    const row = isLit ? this.#lit?.row : this.#row;
    const start = row && picture.frames?.[row - 1];
    const values = row && picture.values?.[row - 1];
    if (!row || !start || !values) return null;
    const moves = movesOf(values, this.#convention);
    const current = isLit ? moves.findIndex(({ parameter }) => parameter === this.#lit?.parameter) : this.#current;
    const at = isLit ? MOVES : this.playback.at;
    const text = at > 0 ? amountText(moves[current], row, this.#convention, this.unit) : "";
    const gap = isLit ? null : this.#axisGap(frameAt(start, moves, at))?.gap ?? null;
    return { start, moves, at, current, isLit, text, gap };
  }

  /**
   * Return the joint on whose axis the row must end, and the gap between a frame and this axis. Return null before the
   * last move has ended, and if the exercise compares no frames.
   *
   * @param {Front.Frame} frame
   */
  #axisGap(frame) {
    const { table, joints, mechanism } = this.#answer;
    const shown = this.#picture.mechanism;
    if (this.playback.at < MOVES || !table || !mechanism?.comparable || !shown) return null;
    const i = jointAfter(this.#row - 1, table.row_joints, joints.length, this.#convention);
    if (i === null) return null;
    const axis = { centre: shown.centres[i], axis: shown.axes[i], slides: joints[i].kind === "P" };
    return { joint: joints[i].joint, gap: axisGap(frame, axis) };
  }

  // The motion of the ghost frame.

  #run() {
    if (this.playback.isRunning) return this.playback.stop();
    if (this.playback.at >= MOVES) this.playback.at = 0;
    this.#play(MOVES);
    return undefined;
  }

  /** @param {number} end */
  #play(end) {
    const still = this.#moves(this.#row).map(({ amount }) => Math.abs(amount) < SMALL);
    this.playback.play(end, (i) => still[i]);
    this.#write();
  }

  /** Play the next move, or go back to the start of the current move. @param {number} direction */
  #step(direction) {
    const at = this.playback.at;
    if (direction > 0) return this.#play(Math.min(MOVES, Math.floor(at + SMALL) + 1));
    this.#jump(Math.max(0, Math.ceil(at - SMALL) - 1));
    return this.#announce();
  }

  /** @param {number} at */
  #jump(at) {
    this.playback.stop();
    this.playback.at = at;
    this.#moved();
  }

  /** @param {number} row */
  #choose(row) {
    this.#row = row;
    this.#jump(0);
    this.#announce();
  }

  #moved() {
    this.#write();
    this.#draw();
  }

  /** Draw the row, unless the view is a drawing by the service, which shows none. */
  #draw() {
    if (!this.view.isFlat()) this.view.draw();
  }

  /** @param {boolean} isEnd */
  #stopped(isEnd) {
    this.#write();
    if (isEnd) this.#announce();
  }

  // Texts.

  #announce() {
    this.view.host.announce([this.caption, this.told].map((each) => each.dataset.text).join(" "));
  }

  /**
   * Show a text with its names typeset. Return true if it has changed.
   *
   * @param {HTMLElement} element
   * @param {string} text
   */
  #say(element, text) {
    if (element.dataset.text === text) return false;
    element.dataset.text = text;
    element.replaceChildren(...typeset(text));
    return true;
  }

  #write() {
    const at = this.playback.at;
    const [row, convention, unit] = [this.#row, this.#convention, this.unit];
    const moves = this.#moves(row);
    const caption = captionText({ row, at, moves, convention, unit });
    // While a move is played, change only the bar: any other change makes the browser lay out the page.
    if (this.#say(this.caption, caption)) this.bar.setAttribute("aria-valuetext", caption);
    if (!this.bar.matches(":active")) this.bar.value = String(at);
    const run = this.playback.isRunning ? worded("Pause") : worded("Play");
    if (this.run.textContent !== run) this.run.textContent = run;
    this.back.disabled = at <= 0;
    this.next.disabled = at >= MOVES;
    const texts = moves.map((move) => moveText(move, row, convention, unit));
    if (this.list.dataset.texts !== texts.join()) {
      this.list.dataset.texts = texts.join();
      this.list.replaceChildren(...texts.map((text) => h("li", {}, ...typeset(text))));
    }
    const current = at > 0 ? this.#current : -1;
    [...this.list.children].forEach((item, i) => {
      if (i !== current) item.removeAttribute("aria-current");
      else if (!item.hasAttribute("aria-current")) item.setAttribute("aria-current", "step");
    });
    this.#tell(moves);
    this.#mark(this.element.hidden || current < 0 ? null : moves[current].parameter);
  }

  /** Say where the ghost frame is after a move, and what the row misses at its end. @param {Front.Move[]} moves */
  #tell(moves) {
    const start = this.#picture.frames?.[this.#row - 1];
    this.told.classList.remove("misses");
    if (this.playback.isRunning || !start) return this.#say(this.told, "");
    const frame = frameAt(start, moves, this.playback.at);
    const lines = [placeText(frame)];
    const found = this.#axisGap(frame);
    if (found) lines.push(axisText(this.#row, found.joint, found.gap, this.unit));
    const tool = this.#toolGap(frame);
    if (tool) lines.push(gapSentence(tool, this.unit));
    this.#say(this.told, lines.join(" "));
    return this.told.classList.toggle("misses", [found?.gap, tool].some((gap) => gap && !isClosed(gap)));
  }

  /** @param {Front.Frame} frame */
  #toolGap(frame) {
    const { table, mechanism } = this.#answer;
    const tool = this.#picture.mechanism?.frames.at(-1);
    const isEnd = this.playback.at >= MOVES && this.#row === this.#picture.values?.length;
    return isEnd && table?.complete && mechanism?.comparable && tool ? gapBetween(frame, tool) : null;
  }

  /** Mark the cell of the current move in the table. @param {string | null} parameter */
  #mark(parameter) {
    const cells = this.view.host.cells?.()[this.#row - 1];
    const cell = cells?.find(({ place }) => place.label === parameter)?.element ?? null;
    if (cell === this.#cell) return;
    this.#cell?.classList.remove("moving");
    this.#cell = cell;
    cell?.classList.add("moving");
  }

  // The scene.

  /** @param {Front.Shapes} shapes @param {number} size @param {HTMLElement} stage */
  shape(shapes, size, stage) {
    return this.#Shape && new this.#Shape(shapes, size, stage);
  }

  close() {
    this.playback.stop();
    this.#mark(null);
  }
}
