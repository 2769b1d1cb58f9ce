// The bar above a generated robot: its level and convention, and the next robot.

import { h } from "../../shared/dom.js";
import { inConvention, robotOf, slipIn } from "./robot_ids.js";
import { keepSolved, solvedOf } from "./solved.js";
import { favoured, noteDealt, noteGraded } from "./spaced.js";
import { conventionName } from "../../shared/words/phrases.js";
import { worded, wordedFor } from "../../shared/words/words.js";

const LEVELS = [worded("1: first robots"), worded("2: arms"), worded("3: offsets and wrists"), worded("4: any angle")];
const CONVENTIONS = ["standard", "modified"];
const MOST = LEVELS.length;

export class PracticeBar {
  /** @param {Front.PracticeHost} host */
  constructor(host) {
    this.host = host;
    /** @type {HTMLSelectElement} */
    this.level = h(
      "select",
      { id: "practice-level", onchange: () => this.deal(this.#level) },
      ...LEVELS.map((text, i) => h("option", { value: i + 1 }, text)),
    );
    /** @type {HTMLSelectElement} */
    this.convention = h(
      "select",
      { id: "practice-convention", onchange: () => this.#switch() },
      ...CONVENTIONS.map((value) => h("option", { value }, conventionName(value))),
    );
    this.easier = this.#button(worded("Easier"), () => this.deal(this.#level - 1));
    this.another = this.#button(worded("Another like this"), () => this.deal(this.#level));
    this.harder = this.#button(worded("Harder"), () => this.deal(this.#level + 1));
    this.link = h("a", {}, worded("Link to this robot"));
    this.done = h("p", { class: "practice-done" });
    this.element = h(
      "section",
      { class: "practice", "aria-label": worded("Practice"), hidden: true },
      h("p", {}, h("label", { for: "practice-level" }, worded("Level")), " ", this.level),
      h("p", {}, h("label", { for: "practice-convention" }, worded("Convention")), " ", this.convention),
      h("div", { class: "practice-next" }, this.easier, this.another, this.harder),
      this.done,
      h("p", { class: "practice-link" }, this.link),
    );
    host.addEventListener("graded", (event) => this.#graded(/** @type {CustomEvent} */ (event).detail));
  }

  /** @param {string} text @param {() => void} onclick */
  #button(text, onclick) {
    return h("button", { type: "button", class: "quiet-button", onclick }, text);
  }

  get #level() {
    return Number(this.level.value);
  }

  /**
   * Load the next robot of a level into the element. Without a level, the attribute `practice` has the level.
   *
   * @param {number} [level]
   */
  async deal(level) {
    const last = this.host.getAttribute("exercise");
    const wanted = level ?? Math.min(Math.max(Math.round(Number(this.host.getAttribute("practice"))) || 1, 1), MOST);
    const convention = level ? this.convention.value : this.host.getAttribute("convention") ?? CONVENTIONS[0];
    const after = robotOf(last) ? last : null;
    const { service } = this.host;
    const favour = favoured(service.base);
    try {
      const { id } = await service.nextRobot(wanted, convention, after, favour);
      noteDealt(service.base, id, favour);
      // The page may have chosen a robot meanwhile.
      if (this.host.getAttribute("exercise") === last) this.host.setAttribute("exercise", id);
    } catch (error) {
      if (!level) throw error;
      this.show();
      this.host.failed(error);
    }
  }

  #switch() {
    const id = this.host.getAttribute("exercise");
    if (id) this.host.setAttribute("exercise", inConvention(id, this.convention.value));
  }

  /** @param {Api.Report} report */
  #graded(report) {
    if (this.element.hidden) return;
    const { id, symbols } = this.host.exercise;
    const sliding = symbols.flatMap(({ joint, kind }) => (joint && kind === "length" ? [joint] : []));
    const { base } = this.host.service;
    const isSolved = report.points >= report.max_points;
    const slip = slipIn(report, sliding);
    if (slip || isSolved) noteGraded(base, id, slip);
    if (isSolved) keepSolved(base, this.#level, id);
    this.show();
  }

  /** Show the level and the convention of the robot in the element, and what is solved. Other exercises have no bar. */
  show() {
    const id = this.host.getAttribute("exercise");
    const robot = robotOf(id);
    this.element.hidden = !robot || !this.host.hasAttribute("practice");
    if (!robot || !id) return;
    const { base } = this.host.service;
    this.level.value = String(robot.level);
    this.convention.value = robot.convention;
    this.easier.disabled = robot.level === 1;
    this.harder.disabled = robot.level === MOST;
    this.link.href = `${base}exercises/${id}`;
    const solved = solvedOf(base, robot.level);
    const isDone = solved.includes(id);
    const count = solved.length;
    this.done.classList.toggle("is-done", isDone);
    this.done.replaceChildren(
      ...(isDone ? [h("strong", {}, "✓ ", worded("Done")), " · "] : []),
      wordedFor("1 robot of this level solved", "{count} robots of this level solved", count),
    );
  }
}
