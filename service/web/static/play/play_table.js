// The table of free play: rows that come and go, each of a joint that turns or slides, or of none.

import { Cell } from "../shared/cell.js";
import { h } from "../shared/dom.js";
import { target, undoKey } from "../shared/keyboard.js";
import { blockOf, placedFrom } from "../shared/pasted_block.js";

const COLUMNS = ["a", "alpha", "d", "theta"];
const SPOKEN = { a: "a, link length", alpha: "alpha, link twist", d: "d, link offset", theta: "theta, joint angle" };
const LETTERS = { a: "a", alpha: "α", d: "d", theta: "θ" };
const KINDS = { R: "R, turns", P: "P, slides", F: "fixed" };
const KINDS_SHORT = { R: "R", P: "P", F: "–" };
export const MOST_ROWS = 12;
export const MOST_JOINTS = 10;

const D = 2;
const THETA = 3;

/** The cells of a new row of joint `number`. */
export function freshCells(kind, number) {
  return ["0", "0", kind === "P" ? `d${number}` : "0", kind === "R" ? `theta${number}` : "0"];
}

/** The number of the joint of each row; null where there is none. */
export function jointNumbers(rows) {
  let count = 0;
  return rows.map(({ kind }) => (kind === "F" ? null : ++count));
}

export class PlayTable {
  /** `host` hears: typed(cell), filled(pairs), kindChanged(i, kind), removed(i), pasted(text), undone(direction). */
  constructor(host) {
    this.host = host;
    this.rows = [];
    this.head = h("tr");
    this.body = h("tbody");
    const caption = h("caption", { class: "aloud" }, "Denavit-Hartenberg table");
    this.element = h(
      "div",
      { class: "scroll" },
      h("table", { class: "table" }, caption, h("thead", {}, this.head), this.body),
    );
  }

  /** Draw all rows anew. */
  show({ rows, convention }) {
    const before = convention === "modified" ? "i−1" : "i";
    const heads = COLUMNS.map((label) => {
      const index = label === "a" || label === "alpha" ? before : "i";
      const seen = h("span", { "aria-hidden": "true" }, h("i", {}, LETTERS[label]), h("sub", {}, index));
      return h("th", { scope: "col" }, seen, h("span", { class: "aloud" }, SPOKEN[label]));
    });
    const aloud = (text) => h("th", { scope: "col" }, h("span", { class: "aloud" }, text));
    this.head.replaceChildren(aloud("row"), aloud("joint"), ...heads, aloud("remove"));
    const joints = jointNumbers(rows).filter(Boolean).length;
    this.rows = rows.map((row, i) => this.#row(row, i, joints));
    this.body.replaceChildren(...this.rows.map((row) => row.element));
  }

  #row({ kind, cells }, i, joints) {
    const number = i + 1;
    const options = Object.entries(KINDS).map(([value, text]) =>
      h("option", { value, selected: value === kind, title: text }, KINDS_SHORT[value])
    );
    if (kind === "F" && joints >= MOST_JOINTS) { for (const option of options.slice(0, 2)) option.disabled = true; }
    const choice = h("select", {
      "aria-label": `Joint of row ${number}: R turns, P slides, – none`,
      onchange: (event) => this.host.kindChanged(i, event.target.value),
    }, ...options);
    const made = COLUMNS.map((label, j) => {
      const cell = new Cell(
        { id: `play-${i}-${j}`, place: [i, j], label, spoken: `${SPOKEN[label]}, row ${number}` },
        this,
      );
      cell.input.value = cells[j];
      return cell;
    });
    const remove = h("button", {
      type: "button",
      class: "quiet-button remove",
      "aria-label": `Remove row ${number}`,
      title: "Remove row",
      onclick: () => this.host.removed(i),
    }, "×");
    const head = h("th", { scope: "row" }, String(number));
    return {
      cells: made,
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

  /** Show below each cell how the service reads it. */
  showReadings({ unread, formulas }) {
    const errors = new Map(unread.map(({ row, column, error }) => [`${row} ${column}`, error]));
    this.rows.forEach((row, i) =>
      row.cells.forEach((cell, j) => {
        const error = errors.get(`${i + 1} ${cell.label}`);
        const formula = formulas?.cells[i]?.[j];
        if (error) cell.understood(cell.text.trim() ? { error } : null);
        else cell.understood(formula?.text ? formula : null);
      })
    );
  }

  // What a cell tells.

  changed(cell) {
    cell.understood(null);
  }

  typed(cell) {
    this.host.typed(cell);
  }

  entered() {}

  understood() {}

  beforeInput(event) {
    const undone = { historyUndo: "undo", historyRedo: "redo" }[event.inputType];
    if (undone) this.#undo(event, undone);
  }

  #undo(event, direction) {
    event.preventDefault();
    this.host.undone(direction);
  }

  repaired(cell, suggestion) {
    this.host.filled([[cell, suggestion]]);
    cell.input.focus();
  }

  pressed(event, cell) {
    const undone = undoKey(event);
    if (undone) return this.#undo(event, undone);
    const next = target(event, cell, this.rows.map((row) => row.cells));
    if (!next) return undefined;
    event.preventDefault();
    next.input.focus();
    return next.input.select();
  }

  /** A block smaller than a table goes where the cursor is; what a whole table is, the service says. */
  pasted(event, cell) {
    const text = event.clipboardData.getData("text/plain");
    if (!/[\n\t;&|]/.test(text.trim())) return;
    event.preventDefault();
    const block = blockOf(text);
    const isSmall = block && (block.length === 1 || block[0].length < COLUMNS.length);
    const pairs = isSmall ? placedFrom(cell, this.rows.map((row) => row.cells), block) : null;
    if (pairs) this.host.filled(pairs);
    else this.host.pasted(text);
  }
}

/** Rows from the cells of a pasted table: a joint slides where only d holds its variable. */
export function rowsOf(cells) {
  return cells.map((texts, i) => {
    const number = i + 1;
    const own = (text) => new RegExp(`\\b(theta|q|d)_?${number}\\b`).test(text);
    const slides = own(texts[D]) && !new RegExp(`\\b(theta|q)_?${number}\\b`).test(texts[THETA]);
    const kind = slides ? "P" : own(texts[THETA]) ? "R" : "F";
    const named = slides ? texts[D].replace(new RegExp(`\\btheta${number}\\b`), `d${number}`) : texts[D];
    return { kind, cells: [texts[0], texts[1], named, texts[THETA]] };
  });
}
