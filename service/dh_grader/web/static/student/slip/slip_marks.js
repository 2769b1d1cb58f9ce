// A given table with a slip: each cell is a button that marks the cell as wrong, each row number marks the whole row.

import { h } from "../../shared/dom.js";
import { SIGNS } from "../../shared/cell.js";
import { typeset } from "../../typeset/names.js";
import { verdictName } from "../../shared/words/phrases.js";
import { worded } from "../../shared/words/words.js";

/** Return the text of a cell with the sign for degrees. @param {string} text */
const withDegrees = (text) => text.replace(/(\d)deg\b/g, "$1°");

export class SlipMarks {
  /** @type {Map<string, HTMLButtonElement>} */
  #buttons = new Map();
  #sign = h("span", { class: "sign" });

  /**
   * `changed` is called after each click.
   *
   * @param {Front.Grid} grid the columns and rows of the table
   * @param {string[][]} given
   * @param {Set<string>} symbols
   * @param {() => void} changed
   */
  constructor(grid, given, symbols, changed) {
    this.changed = changed;
    const heads = grid.columns.map(({ head, index, spoken }) => {
      const seen = h("span", { "aria-hidden": "true" }, h("i", {}, head), h("sub", {}, index ?? ""));
      return h("th", { scope: "col" }, seen, h("span", { class: "aloud" }, spoken));
    });
    const rows = grid.rows.map((row, i) => {
      const cells = grid.columns.map((column, j) => {
        const label = `${worded("{column}, row {row}", { column: column.spoken, row: row.spoken })}: `;
        const button = this.#toggle(label, typeset(withDegrees(given[i][j]), symbols));
        this.#buttons.set(`${row.label}.${column.label}`, button);
        return button;
      });
      const whole = h(
        "button",
        {
          type: "button",
          class: "quiet-button",
          onclick: () => this.#toggleAll(cells),
        },
        h("span", { class: "aloud" }, worded("mark row"), " "),
        row.head,
      );
      return h("tr", {}, h("th", { scope: "row" }, whole), ...cells.map((cell) => h("td", {}, cell)));
    });
    const corner = h("th", { scope: "col", class: "corner" }, h("span", { class: "aloud" }, worded("row")));
    const table = h(
      "table",
      { class: "table" },
      h("thead", {}, h("tr", {}, corner, ...heads)),
      h("tbody", {}, ...rows),
    );
    const legend = h("legend", {}, worded("The given table: mark what is wrong"), " ", this.#sign);
    this.element = h("fieldset", { class: "slip-marks" }, legend, h("div", { class: "scroll" }, table));
  }

  /** @param {string} label @param {(string | Element)[]} shown */
  #toggle(label, shown) {
    const button = h(
      "button",
      {
        type: "button",
        class: "slip-mark",
        "aria-pressed": "false",
        onclick: () => {
          press(button, !isPressed(button));
          this.changed();
        },
      },
      h("span", { class: "aloud" }, label),
      ...shown,
    );
    return button;
  }

  /** Mark all of the cells, or none if all are marked. @param {HTMLButtonElement[]} cells */
  #toggleAll(cells) {
    const isMarked = cells.every(isPressed);
    for (const cell of cells) press(cell, !isMarked);
    this.changed();
  }

  /** True if no cell is marked, and the mended table has no text. @param {string[]} texts */
  isUntouched(texts) {
    return !this.value && texts.every((text) => text === "");
  }

  /** The marked cells as the answer names them: "2.alpha, 3.d". */
  get value() {
    return [...this.#buttons].filter(([, button]) => isPressed(button)).map(([place]) => place).join(", ");
  }

  set value(marked) {
    const places = new Set(marked.split(",").map((place) => place.trim()));
    for (const [place, button] of this.#buttons) press(button, places.has(place));
  }

  /** Show the verdict on the marks; null removes the verdict. @param {Api.Verdict | null} verdict */
  show(verdict) {
    if (verdict) this.element.dataset.verdict = verdict;
    else delete this.element.dataset.verdict;
    const signs = verdict
      ? [h("span", { "aria-hidden": "true" }, SIGNS[verdict]), h("span", { class: "aloud" }, verdictName(verdict))]
      : [];
    this.#sign.replaceChildren(...signs);
  }

  /** The first marked cell if the marks are wrong, or else null. */
  get wrong() {
    const { verdict } = this.element.dataset;
    const isWrong = verdict === "incorrect" || verdict === "partial" || verdict === "unreadable";
    return isWrong ? [...this.#buttons.values()].find(isPressed) ?? null : null;
  }

  /** Prevent changes of the marks. */
  lock() {
    for (const button of this.element.querySelectorAll("button")) button.disabled = true;
  }
}

/** @param {HTMLButtonElement} button */
const isPressed = (button) => button.getAttribute("aria-pressed") === "true";

/** @param {HTMLButtonElement} button @param {boolean} isOn */
const press = (button, isOn) => button.setAttribute("aria-pressed", String(isOn));
