// The grids of a part as tables: headings, rows of cells, and messages below each row.

import { h, points } from "../shared/dom.js";
import { Cell, SIGNS } from "../shared/cell.js";
import { withScrollSign } from "./form/scroll_sign.js";
import { typeset } from "../typeset/names.js";
import { verdictName } from "../shared/words/phrases.js";
import { worded } from "../shared/words/words.js";

const HOME = new URL("../", import.meta.url).href;

/**
 * Return the rows of a layout in order (`rows`), and their tables (`elements`).
 *
 * @param {Front.Layout} layout
 * @param {Api.Part} part
 * @param {Front.CellOwner<Front.PartPlace>} owner
 * @param {string} idPrefix
 */
export function gridsOf(layout, part, owner, idPrefix) {
  /** @type {RowView[]} */
  const rows = [];
  const elements = layout.grids.map((grid, i) => gridElement(grid, part, owner, `${idPrefix}-${i}`, rows));
  return { rows, elements };
}

/**
 * @param {Front.Grid} grid
 * @param {Api.Part} part
 * @param {Front.CellOwner<Front.PartPlace>} owner
 * @param {string} id
 * @param {RowView[]} rows
 */
function gridElement(grid, part, owner, id, rows) {
  const heads = grid.columns.map((column) => headOf(column));
  const isMatrix = grid.look === "matrix";
  const head = h(
    "tr",
    {},
    h("th", { scope: "col", class: "corner" }, h("span", { class: "aloud" }, worded("row"))),
    ...heads,
    h("th", { scope: "col", class: "worth" }, h("span", { class: "aloud" }, worded("points"))),
  );
  const body = h("tbody");
  grid.rows.forEach((row, i) => {
    const view = new RowView(row, grid, part, owner, `${id}-${i}`);
    if (isMatrix && i === 0) view.element.classList.add("top");
    if (isMatrix && i === grid.rows.length - 1) view.element.classList.add("bottom");
    rows.push(view);
    body.append(view.element, view.notes);
  });
  const caption = h(
    "caption",
    { class: grid.title ? "named" : "aloud" },
    ...typeset(grid.title || part.title),
    helpOf({ ...grid, head: grid.title }),
  );
  const look = `${grid.look}${isWide(grid) ? " wide" : ""}`;
  const table = h("table", { class: look }, caption, h("thead", { class: isMatrix ? "aloud" : null }, head), body);
  return withScrollSign(h("div", { class: "scroll" }, table));
}

/** True if a phone shows each row of the table as two lines. @param {Front.Grid} grid */
const isWide = ({ look, columns }) => look === "table" && columns.length > 4;

/** @param {Front.Column} column */
const letterOf = ({ head, index }) => [h("i", {}, head), index ? h("sub", {}, index) : null];

/** @param {Front.Column} column */
function headOf(column) {
  return h(
    "th",
    { scope: "col" },
    h("span", { "aria-hidden": column.spoken ? "true" : null }, ...letterOf(column)),
    column.spoken ? h("span", { class: "aloud" }, column.spoken) : null,
    helpOf(column),
  );
}

/**
 * Return the link to the explanation of a column or a table, which opens in a new tab.
 *
 * @param {{ head: string, help?: string }} explained
 */
function helpOf({ head, help }) {
  if (!help) return null;
  const name = worded("What is {column}?", { column: head });
  const href = new URL(help, HOME).href;
  return h("a", { class: "what", href, target: "_blank", rel: "noopener", title: name, "aria-label": name }, "?");
}

/** A row of a grid with its cells, verdict and points, and below it a row for its messages. */
export class RowView {
  /**
   * @param {Front.Row} row
   * @param {Front.Grid} grid
   * @param {Api.Part} part
   * @param {Front.CellOwner<Front.PartPlace>} owner
   * @param {string} id
   */
  constructor(row, grid, part, owner, id) {
    this.grid = grid;
    this.label = row.label;
    this.name = row.spoken || part.title;
    this.sign = h("span", { class: "sign" });
    this.isGiven = Boolean(row.isGiven);
    this.worth = h("td", { class: "worth" }, this.isGiven && worded("given"));
    this.cells = grid.columns.map((column, j) => {
      const isNumber = row.spoken && grid.look === "table" && !grid.hasNamedRows;
      const name = isNumber ? worded("row {row}", { row: row.spoken }) : row.spoken;
      const where = [column.spoken, name, row.isGiven && worded("given")];
      const cell = new Cell(
        {
          id: `${id}-${j}`,
          part: part.id,
          label: column.label,
          row: this,
          quantity: row.quantity ?? column.quantity,
          spoken: where.filter(Boolean).join(", "),
          prefill: row.prefill?.[j],
          offers: column.offers,
          isGiven: row.isGiven,
        },
        owner,
      );
      // Phones show it above the cell, in place of the head of the column.
      if (isWide(grid)) {
        cell.element.prepend(h("span", { class: "cell-head", "aria-hidden": "true" }, ...letterOf(column)));
      }
      return cell;
    });
    const aloud = h("span", { class: "aloud" }, row.head);
    const head = h(
      "th",
      { scope: "row" },
      h("span", { "aria-hidden": "true" }, ...typeset(row.head, new Set([row.head]))),
      aloud,
      this.sign,
    );
    this.element = h(
      "tr",
      { class: this.isGiven ? "given" : null },
      head,
      ...this.cells.map((cell) => cell.element),
      this.worth,
    );
    this.list = h("ul");
    // In a matrix, messages leave the first and the last column free, so that the brackets continue beside them.
    const isMatrix = grid.look === "matrix";
    const place = h("td", { colspan: grid.columns.length + (isMatrix ? 0 : 2) }, this.list);
    this.notes = h("tr", { class: "notes", hidden: true }, ...(isMatrix ? [h("td"), place, h("td")] : [place]));
  }

  /**
   * Show the marks and messages of a report on the row; null removes them.
   *
   * @param {Api.RowReport | null} report
   * @param {HTMLElement[]} [items]
   */
  mark(report, items = []) {
    this.setVerdict(report?.verdict ?? null);
    this.#showWorth(report?.max_points ? points(report.points, report.max_points) : "");
    const cells = new Map(report?.cells.map((cell) => [cell.label, cell]));
    for (const cell of this.cells) cell.mark(cells.get(cell.place.label) ?? null);
    this.list.replaceChildren(...items);
    this.notes.hidden = items.length === 0;
  }

  /** Add a message that does not come from a report. @param {HTMLElement} item */
  addNote(item) {
    this.list.append(item);
    this.notes.hidden = false;
  }

  /** @param {HTMLElement} item */
  removeNote(item) {
    item.remove();
    this.notes.hidden = !this.list.childElementCount;
  }

  get verdict() {
    return /** @type {Api.Verdict | undefined} */ (this.element.dataset.verdict) ?? null;
  }

  /** Remove the verdict of the row, because a cell has changed. */
  outdated() {
    this.setVerdict(null);
    this.#showWorth("");
  }

  /** @param {string} text */
  #showWorth(text) {
    this.worth.textContent = this.isGiven ? worded("given") : text;
  }

  /** @param {Api.Verdict | null} verdict */
  setVerdict(verdict) {
    if (verdict) this.element.dataset.verdict = verdict;
    else delete this.element.dataset.verdict;
    this.sign.replaceChildren(
      ...(verdict
        ? [h("span", { "aria-hidden": "true" }, SIGNS[verdict]), h("span", { class: "aloud" }, verdictName(verdict))]
        : []),
    );
  }
}
