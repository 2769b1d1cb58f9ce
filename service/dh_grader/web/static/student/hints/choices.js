// After full marks for a table with frames of the student's choice: other valid tables, each also in 3D.

import { h, visible } from "../../shared/dom.js";
import { typesetMessage } from "../../typeset/names.js";
import { tableWords } from "../robot_figure.js";
import { withScrollSign } from "../form/scroll_sign.js";
import { loadRobotView, NOT_LOADED } from "../../robot/view_loader.js";
import { worded } from "../../shared/words/words.js";

const COLUMNS = /** @type {const} */ (["a", "alpha", "d", "theta"]);
const HEADS = { a: "a", alpha: "α", d: "d", theta: "θ" };

/**
 * Add a button for other choices of frames to a correct table. It goes away when the answer changes.
 *
 * @param {Front.HintHost} host
 * @param {Front.PartView} view
 * @param {Api.PartReport} report
 */
export function offerChoices(host, view, report) {
  view.body.querySelector(".choices")?.dispatchEvent(new Event("close"));
  const { shape } = view.part;
  const isFree = "frames" in shape && shape.frames === "free" && "convention" in shape;
  if (report.verdict !== "correct" || !isFree || shape.convention === "either") return;
  view.body.append(new ChoicesBox(host, view, shape.convention).element);
}

class ChoicesBox {
  /** @type {Front.RobotView | null} */
  #view = null;
  /** @type {HTMLButtonElement | null} */
  #shown = null;

  /**
   * @param {Front.HintHost} host
   * @param {Front.PartView} part
   * @param {Api.Convention} convention
   */
  constructor(host, part, convention) {
    this.host = host;
    this.part = part;
    this.convention = convention;
    this.symbols = new Set(host.exercise.symbols.map(({ name }) => name));
    this.button = h(
      "button",
      { type: "button", class: "quiet-button", onclick: () => this.#ask() },
      worded("Show another valid choice of frames"),
    );
    this.note = h("p", { class: "quiet", role: "status" });
    this.list = h("ul", { hidden: true });
    this.element = h("div", { class: "choices" }, this.button, this.note, this.list);
    const close = () => this.#remove();
    this.element.addEventListener("close", close, { once: true });
    // After a change of the answer, other choices are valid.
    for (const { input } of part.cells) input.addEventListener("input", close, { once: true });
  }

  #remove() {
    this.#close();
    this.element.remove();
  }

  async #ask() {
    if (this.button.getAttribute("aria-disabled") === "true") return;
    this.button.setAttribute("aria-disabled", "true");
    try {
      const { rows } = /** @type {{ rows: Api.TableRow[] }} */ (this.part.answer);
      const body = { part: this.part.part.id, rows, angle_unit: this.host.angleUnit };
      const { choices } = await this.host.service.choices(this.host.exercise.id, body);
      this.note.textContent = choices.length
        ? worded("Each of these tables describes the same robot. They would earn full marks, too.")
        : worded("No other choice was found for this table.");
      this.list.replaceChildren(...choices.map((choice) => this.#item(choice)));
      this.list.hidden = choices.length === 0;
      this.button.hidden = true;
      const first = this.list.querySelector("button");
      if (first) first.focus();
    } catch (error) {
      this.note.textContent = visible(error.message);
    }
    this.button.removeAttribute("aria-disabled");
  }

  /** @param {Api.ValidTable} choice */
  #item({ change, rows }) {
    const own = /** @type {{ rows: Api.TableRow[] }} */ (this.part.answer).rows;
    const maths = (/** @type {string} */ text) => typesetMessage(visible(text), this.symbols);
    const labels = this.part.rows.map(({ label }) => label);
    const table = h(
      "table",
      {},
      h("tr", {}, h("td"), ...COLUMNS.map((name) => h("th", { scope: "col" }, h("i", {}, HEADS[name])))),
      ...rows.map((row, i) =>
        h(
          "tr",
          {},
          h("th", { scope: "row" }, visible(labels[i] ?? "")),
          ...COLUMNS.map((name) =>
            h("td", { class: row[name] === own[i][name] ? null : "changed" }, ...maths(row[name]))
          ),
        )
      ),
    );
    const button = h(
      "button",
      { type: "button", class: "quiet-button", "aria-expanded": "false" },
      worded("Show it in 3D"),
    );
    const item = h(
      "li",
      {},
      h("p", {}, ...maths(change)),
      withScrollSign(h("div", { class: "choice-table" }, table)),
      button,
    );
    button.onclick = () => this.#toggle(button, item, rows);
    return item;
  }

  /** @param {HTMLButtonElement} button @param {HTMLElement} item @param {Api.TableRow[]} rows */
  async #toggle(button, item, rows) {
    const isOpen = this.#shown === button;
    this.#close();
    if (isOpen) return;
    this.#shown = button;
    const { service, exercise, angleUnit } = this.host;
    try {
      const RobotView = await loadRobotView();
      if (this.#shown !== button || !this.element.isConnected) return;
      const table = { rows, convention: this.convention };
      this.#view = new RobotView({
        service,
        body: () => ({ exercise: exercise.id, angle_unit: angleUnit, table }),
        ...tableWords(exercise.symbols, () => []),
        announce: (text) => this.host.announce(text),
      });
      item.append(this.#view.element);
      button.setAttribute("aria-expanded", "true");
      this.#view.open();
    } catch {
      this.#shown = null;
      this.note.textContent = NOT_LOADED;
    }
  }

  #close() {
    this.#view?.close();
    this.#view?.element.remove();
    this.#shown?.setAttribute("aria-expanded", "false");
    this.#view = this.#shown = null;
  }
}
