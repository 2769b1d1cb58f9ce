// The table of free play. Rows can be added and removed; each row is revolute, prismatic or fixed.

import { Cell } from "../shared/cell.js";
import { h } from "../shared/dom.js";
import { target, undoKey } from "../shared/keyboard.js";
import { blockOf, placedFrom } from "../shared/pasted_block.js";
import { LETTERS, SPOKEN } from "../student/kinds.js";
import { jointCount, MOST_JOINTS } from "./rows.js";
import { worded } from "../shared/words/words.js";

const COLUMNS = ["a", "alpha", "d", "theta"];
/** @type {Record<string, { text: string, short: string }>} */
const KINDS = {
  R: { text: worded("R, turns"), short: "R" },
  P: { text: worded("P, slides"), short: "P" },
  F: { text: worded("fixed"), short: "–" },
};

/**
 * @typedef {object} TableHost
 * @property {(cell: Front.PlayCell) => void} typed
 * @property {(pairs: [Front.PlayCell, string][]) => void} filled
 * @property {(i: number, kind: string) => void} kindChanged
 * @property {(i: number) => void} removed
 * @property {(text: string) => void} pasted
 * @property {(direction: Front.Direction) => void} undone
 */

export class PlayTable {
  /** @param {TableHost} host */
  constructor(host) {
    this.host = host;
    /** @type {{ cells: Front.PlayCell[], choice: HTMLSelectElement, element: HTMLElement }[]} */
    this.rows = [];
    this.head = h("tr");
    this.body = h("tbody");
    const caption = h("caption", { class: "aloud" }, worded("Denavit-Hartenberg table"));
    this.element = h(
      "div",
      { class: "scroll" },
      h("table", { class: "table" }, caption, h("thead", {}, this.head), this.body),
    );
  }

  /**
   * Redraw all rows.
   *
   * @param {Pick<Front.Robot, "rows" | "convention">} robot
   */
  show({ rows, convention }) {
    const before = convention === "modified" ? "i−1" : "i";
    const heads = COLUMNS.map((label) => {
      const index = label === "a" || label === "alpha" ? before : "i";
      const seen = h("span", { "aria-hidden": "true" }, h("i", {}, LETTERS[label]), h("sub", {}, index));
      return h("th", { scope: "col" }, seen, h("span", { class: "aloud" }, SPOKEN[label]));
    });
    /** @type {(text: string) => HTMLElement} */
    const aloud = (text) => h("th", { scope: "col" }, h("span", { class: "aloud" }, text));
    this.head.replaceChildren(aloud(worded("row")), aloud(worded("joint")), ...heads, aloud(worded("remove")));
    const joints = jointCount(rows);
    this.rows = rows.map((row, i) => this.#row(row, i, joints));
    this.body.replaceChildren(...this.rows.map((row) => row.element));
  }

  /** @param {Front.PlayRow} row @param {number} i @param {number} joints */
  #row({ kind, cells }, i, joints) {
    const number = i + 1;
    const isFull = kind === "F" && joints >= MOST_JOINTS;
    const options = Object.entries(KINDS).map(([value, { text, short }]) =>
      h("option", { value, selected: value === kind, disabled: isFull && value !== "F", title: text }, short)
    );
    const choice = h("select", {
      "aria-label": worded("Joint of row {row}: R turns, P slides, – none", { row: number }),
      onchange: (event) => this.host.kindChanged(i, event.target.value),
    }, ...options);
    const made = COLUMNS.map((label, j) => {
      /** @type {Front.PlayPlace} */
      const place = {
        id: `play-${i}-${j}`,
        at: [i, j],
        label,
        spoken: worded("{column}, row {row}", { column: SPOKEN[label], row: number }),
      };
      const cell = new Cell(place, this);
      cell.input.value = cells[j];
      return cell;
    });
    const remove = h("button", {
      type: "button",
      class: "quiet-button remove",
      "aria-label": worded("Remove row {row}", { row: number }),
      title: worded("Remove row"),
      onclick: () => this.host.removed(i),
    }, "×");
    const head = h("th", { scope: "row" }, String(number));
    return {
      cells: made,
      choice,
      element: h(
        "tr",
        {},
        head,
        h("td", { class: "kind" }, choice),
        ...made.map((cell) => cell.element),
        h("td", { class: "kind" }, remove),
      ),
    };
  }

  get texts() {
    return this.rows.map((row) => row.cells.map((cell) => cell.text));
  }

  /**
   * Show below each cell how the service reads it.
   *
   * @param {Api.FramesOfTable} table
   */
  showReadings({ unread, formulas }) {
    const errors = new Map(unread.map(({ row, column, error }) => [`${row} ${column}`, error]));
    this.rows.forEach((row, i) =>
      row.cells.forEach((cell, j) => {
        const error = errors.get(`${i + 1} ${cell.place.label}`);
        const formula = formulas?.cells[i]?.[j];
        if (error) cell.understood(cell.text.trim() ? { error } : null);
        else cell.understood(formula?.text ? formula : null);
      })
    );
  }

  // The methods that the cells call.

  /** @param {Front.PlayCell} cell */
  changed(cell) {
    cell.understood(null);
  }

  /** @param {Front.PlayCell} cell */
  typed(cell) {
    this.host.typed(cell);
  }

  entered() {}

  understood() {}

  /** @param {InputEvent} event */
  beforeInput(event) {
    if (event.inputType === "historyUndo") this.#undo(event, "undo");
    if (event.inputType === "historyRedo") this.#undo(event, "redo");
  }

  /** @param {Event} event @param {Front.Direction} direction */
  #undo(event, direction) {
    event.preventDefault();
    this.host.undone(direction);
  }

  /** @param {Front.PlayCell} cell @param {string} suggestion */
  repaired(cell, suggestion) {
    this.host.filled([[cell, suggestion]]);
    cell.input.focus();
  }

  /** @param {KeyboardEvent} event @param {Front.PlayCell} cell */
  pressed(event, cell) {
    const undone = undoKey(event);
    if (undone) return this.#undo(event, undone);
    const next = target(event, cell, this.rows.map((row) => row.cells));
    if (!next) return undefined;
    event.preventDefault();
    next.input.focus();
    return next.input.select();
  }

  /**
   * Fill the cells from the cursor on with a pasted block. The service reads a text that may be a whole table.
   *
   * @param {ClipboardEvent} event
   * @param {Front.PlayCell} cell
   */
  pasted(event, cell) {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    if (!/[\n\t;&|]/.test(text.trim())) return;
    event.preventDefault();
    const block = blockOf(text);
    const isSmall = block && (block.length === 1 || block[0].length < COLUMNS.length);
    const pairs = isSmall ? placedFrom(cell, this.rows.map((row) => row.cells), block) : null;
    if (pairs) this.host.filled(pairs);
    else this.host.pasted(text);
  }
}
