// A question of "DH in ten minutes": the service grades the answer, and explains the mistakes in it.

import { h } from "../shared/dom.js";
import { ARM, ROWS } from "./tour_robot.js";
import { typesetMessage } from "../typeset/names.js";
import { worded } from "../shared/words/words.js";

const COLUMNS = ["a", "alpha", "d", "theta"];
/** The meaning of each length in the picture. @type {Record<string, string>} */
const LENGTHS = {
  h: worded("h is the height of the column."),
  w: worded("w is the length of link 1."),
  r: worded("r is the length of link 2."),
};

export class Question {
  /** @type {Api.Convention} */
  #convention = "standard";
  #turn = 0;

  /**
   * `solved` is called when the answer is correct.
   *
   * @param {HTMLFormElement} form
   * @param {Front.Service} service
   * @param {() => void} solved
   */
  constructor(form, service, solved) {
    this.form = form;
    this.service = service;
    this.solved = solved;
    this.told = h("div", { class: "told", role: "status" });
    this.show = h(
      "button",
      { type: "button", class: "quiet-button", hidden: true, onclick: () => this.#explain() },
      worded("Show me"),
    );
    this.check = h("button", { type: "submit", class: "check" }, worded("Check"));
    form.append(h("div", { class: "buttons" }, this.check, this.show), this.told);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.#check();
    });
  }

  /** The explanation of the answer in the current convention. */
  get #why() {
    const all = [...(this.form.closest(".screen")?.querySelectorAll(".why") ?? [])];
    const found = all.find((each) => !each.matches(".standard, .modified") || each.matches(`.${this.#convention}`));
    // Omit the name of the convention, which is for readers without scripts.
    return [...found?.childNodes ?? []].filter((each) => each.nodeName !== "B").map((each) => each.textContent).join("")
      .trim();
  }

  /** Ask the question in another convention. @param {Api.Convention} convention @param {boolean} isSolved */
  ask(convention, isSolved) {
    this.#convention = convention;
    this.#turn += 1;
    this.show.hidden = true;
    this.form.reset();
    this.#tell("", isSolved ? worded("You have solved this.") : "");
  }

  /** @returns {{ part: string, answer: unknown, row: string, cells: string[] } | null} */
  get #answer() {
    const { labels, texts } = ARM[this.#convention];
    const cell = this.form.dataset.cell ?? "";
    const written = [...this.form.querySelectorAll("input")];
    if (cell === "direction") {
      const chosen = written.find(({ checked }) => checked);
      return chosen ? { part: "direction", answer: chosen.value.split(" "), row: "", cells: [] } : null;
    }
    const values = written.map(({ value }) => value.trim().replaceAll("−", "-"));
    if (values.includes("")) return null;
    const i = ROWS[cell][this.#convention];
    const row = values.length > 1 ? values : texts[i].with(COLUMNS.indexOf(cell), values[0]);
    const cells = values.length > 1 ? COLUMNS : [cell];
    return { part: "table", answer: texts.with(i, row), row: labels[i], cells };
  }

  async #check() {
    const asked = this.#answer;
    if (!asked) return this.#tell("incorrect", worded("Give an answer first."));
    const turn = ++this.#turn;
    this.check.setAttribute("aria-busy", "true");
    try {
      const body = { answers: { [asked.part]: asked.answer }, angle_unit: /** @type {Api.AngleUnit} */ ("degrees") };
      const report = await this.service.grade(ARM[this.#convention].exercise, body);
      if (turn === this.#turn) this.#judge(report.parts.find(({ part }) => part === asked.part), asked);
    } catch (error) {
      if (turn === this.#turn) this.#tell("incorrect", error.message);
    }
    return this.check.removeAttribute("aria-busy");
  }

  /** @param {Api.PartReport | undefined} report @param {{ row: string, cells: string[] }} asked */
  #judge(report, { row, cells }) {
    if (report?.verdict === "correct") {
      this.show.hidden = true;
      this.#tell("correct", worded("Right. {why}", { why: this.#why }));
      return this.solved();
    }
    const found = report?.rows.find(({ label }) => label === row)?.cells.filter(({ label }) => cells.includes(label)) ??
      [];
    const ofCells = found.flatMap(({ feedback }) => feedback);
    const ofPart = cells.length ? report?.feedback ?? [] : [];
    const texts = [...new Set([...ofCells, ...ofPart].map((each) => each.message))];
    const written = [...this.form.querySelectorAll("input")];
    const choice = written.find(({ checked }) => checked)?.dataset.whyNot;
    if (choice) texts.push(choice);
    // Explain a length that belongs into another cell.
    for (const { label, verdict } of found) {
      const length = LENGTHS[written[cells.indexOf(label)]?.value.trim()];
      if (verdict === "incorrect" && length) texts.push(length);
    }
    this.show.hidden = false;
    return this.#tell(
      "incorrect",
      texts.length
        ? worded("Not yet. {why}", { why: texts.join(" ") })
        : worded("Not yet. Look at the picture again, and read the rule above."),
    );
  }

  #explain() {
    this.#tell("", this.#why);
  }

  /** @param {string} verdict @param {string} text */
  #tell(verdict, text) {
    this.told.dataset.verdict = verdict;
    this.told.replaceChildren(...typesetMessage(text));
  }
}
