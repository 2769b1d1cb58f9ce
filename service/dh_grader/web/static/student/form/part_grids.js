// All grids of a part: their cells with texts, and tabs if there are several grids.

import { gridsOf } from "../grid_view.js";
import { filled, isTouched, sentTexts, shownTexts, together } from "./part_progress.js";
import { Tabs } from "./tabs.js";

/** @param {Front.PartCell} cell @returns {Front.Written} */
const written = ({ text, place: { prefill } }) => ({ text, prefill });

/** @param {Front.RowView} row */
const isFull = ({ cells }) => cells.every(({ text }) => text.trim() !== "");

export class PartGrids {
  /**
   * @param {Front.Layout} layout
   * @param {Api.Part} part
   * @param {Front.CellOwner<Front.PartPlace>} owner
   */
  constructor(layout, part, owner) {
    const id = `part-${part.id}`;
    const { rows, elements } = gridsOf(layout, part, owner, id);
    const titles = layout.grids.map(({ title }) => title);
    this.rows = rows;
    this.cells = rows.flatMap((row) => row.cells);
    /** The rows of each grid. */
    this.grids = layout.grids.map((grid) => rows.filter((row) => row.grid === grid));
    this.tabs = titles.length > 1 ? new Tabs(id, part.title, titles, elements) : null;
    this.elements = this.tabs?.panels ?? elements;
  }

  get #written() {
    return this.grids.map((rows) => rows.flatMap((row) => row.cells.map(written)));
  }

  /** The texts as they are sent and saved. */
  get texts() {
    return this.#written.flatMap(sentTexts);
  }

  /** Return saved texts as the cells show them. @param {string[]} saved */
  shown(saved) {
    let from = 0;
    return this.#written.flatMap((cells) => shownTexts(cells, saved.slice(from, from += cells.length)));
  }

  /** The first cell of the visible grid. */
  get first() {
    const rows = this.grids[this.tabs?.shown ?? 0];
    return (rows.find(({ isGiven }) => !isGiven) ?? rows[0]).cells[0];
  }

  /** Choose the tab of a cell. @param {Front.PartCell} cell */
  show(cell) {
    this.tabs?.show(this.grids.findIndex((rows) => rows.includes(cell.place.row)));
  }

  /** True if the student has written into the grid of a cell. @param {Front.PartCell} cell */
  isBegun({ place }) {
    return this.grids.some((rows) =>
      rows.includes(place.row) && isTouched(rows.flatMap((row) => row.cells.map(written)))
    );
  }

  /** How many matrices are filled; if there is only one grid, how many rows are filled. */
  get progress() {
    if (this.tabs) return { done: filled(this.#written), of: this.grids.length };
    const own = this.rows.filter(({ isGiven }) => !isGiven);
    return { done: isTouched(this.cells.map(written)) ? own.filter(isFull).length : 0, of: own.length };
  }

  /** If the key Tab leaves the last cell of a tab, return the first cell of the next tab, or else null.
   *
   * @param {KeyboardEvent} event
   * @param {Front.PartCell} cell
   */
  afterTab(event, cell) {
    if (event.key !== "Tab" || event.shiftKey || !this.tabs) return null;
    const next = this.cells[this.cells.indexOf(cell) + 1];
    return next && next.place.row.grid !== cell.place.row.grid ? next : null;
  }

  /** Mark each tab with the verdict of its grid, or as filled. */
  markTabs() {
    if (!this.tabs) return;
    for (const [i, cells] of this.#written.entries()) {
      this.tabs.mark(i, together(this.grids[i].map((row) => row.verdict)), filled([cells]) === 1);
    }
  }
}
