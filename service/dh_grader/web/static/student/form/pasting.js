// Texts pasted into a part. The service decides if a text is a table, and which cells it has.

import { blockOf, pair, placedFrom } from "../../shared/pasted_block.js";
import { worded, wordedFor } from "../../shared/words/words.js";

// A text with one of these may hold several cells; the service decides.
const BETWEEN_CELLS = /[\n\t;|&,[]|\\\\/;
const SCRIPT = "unread_script";

export class Pasting {
  /** @param {Front.PartView} view */
  constructor(view) {
    this.view = view;
  }

  /** @param {ClipboardEvent} event @param {Front.PartCell} cell */
  async pasted(event, cell) {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    if (!BETWEEN_CELLS.test(text.trim())) return;
    event.preventDefault();
    const { pairs, told, isScript, notes } = await this.#read(text, cell);
    if (pairs) return this.#fill(pairs, notes);
    // A script, or several lines joined into one, would make the cell unusable.
    if (told && (isScript || text.trim().includes("\n"))) return this.view.line.say(told);
    const before = cell.text;
    cell.input.setRangeText(
      text.replace(/\s*\n\s*/g, " ").trim(),
      cell.input.selectionStart ?? 0,
      cell.input.selectionEnd ?? 0,
      "end",
    );
    const after = cell.text;
    cell.put(after);
    this.view.host.history.note([{ target: cell, before, after }]);
    if (told) this.view.line.say(told);
  }

  /**
   * Fill the cells from a cell on with a whole text. Return an error message, or "".
   *
   * @param {string} text
   * @param {Front.PartCell} cell
   */
  async whole(text, cell) {
    const { pairs, told, notes } = await this.#read(text, cell);
    if (!pairs) return told ?? worded("This text is not a table or matrix that fits here.");
    this.#fill(pairs, notes);
    return "";
  }

  /** @param {[Front.PartCell, string][]} pairs @param {Api.PreviewNote[]} [notes] */
  #fill(pairs, notes) {
    this.view.write(pairs);
    this.view.focus(pairs[0][0]);
    this.view.line.say(
      wordedFor(
        "The pasted text filled 1 cell. Press Ctrl+Z to undo.",
        "The pasted text filled {count} cells. Press Ctrl+Z to undo.",
        pairs.length,
      ),
      notes,
    );
  }

  /**
   * Return the cells that a text fills, or a message if it fills none.
   *
   * @param {string} text
   * @param {Front.PartCell} cell
   */
  async #read(text, cell) {
    const { host, part } = this.view;
    let grid;
    try {
      grid = await host.service.preview({ ...host.context(), part: part.id, text, quantity: cell.place.quantity });
    } catch (error) {
      host.failed(error);
    }
    const block = blockOf(text);
    const pairs = (grid?.rows && this.#placed(grid.rows, cell)) ?? (block && this.#placedBlock(block, cell));
    const misfit = grid?.rows
      ? wordedFor(
        "The pasted text has 1 row, which does not fit here.",
        "The pasted text has {count} rows, which do not fit here.",
        grid.rows.length,
      )
      : grid?.error?.message;
    const told = misfit && !grid?.ok ? worded("Not read as a table or matrix: {reason}", { reason: misfit }) : misfit;
    return { pairs, told, isScript: grid?.error?.code === SCRIPT, notes: grid?.notes };
  }

  /**
   * Return the cells that a pasted grid fills, with their texts, or null if it does not fit.
   *
   * @param {Api.PreviewCell[][]} read
   * @param {Front.PartCell} cell
   * @returns {[Front.PartCell, string][] | null}
   */
  #placed(read, cell) {
    /** @type {(row: Api.PreviewCell[]) => string[]} */
    const texts = (row) => row.map((each) => each.entry);
    const rows = this.view.rows.map((row) => row.cells);
    const isList = rows[0].length === 1 || rows.length === 1;
    if (isList) {
      const flat = read.flatMap(texts);
      const all = rows.flat();
      return flat.length === all.length ? all.map((each, i) => [each, flat[i]]) : null;
    }
    if (read.some((row) => row.length !== rows[0].length)) return null;
    const first = this.#firstRow(read, cell);
    if (first + read.length > rows.length) return null;
    return read.flatMap((row, i) => rows[first + i].map((each, j) => pair(each, row[j].entry)));
  }

  /**
   * Return the cells that a block from a spreadsheet fills, all in the grid of `cell`, or null if it does not fit.
   *
   * @param {string[][]} block
   * @param {Front.PartCell} cell
   */
  #placedBlock(block, cell) {
    const rows = this.view.rows.filter((row) => row.grid === cell.place.row.grid).map((row) => row.cells);
    return placedFrom(cell, rows, block);
  }

  /**
   * Return the first row that a pasted grid fills: the row with the grid's first label. For a single matrix without a
   * name, return the first row of the matrix that contains the cell.
   *
   * @param {Api.PreviewCell[][]} read
   * @param {Front.PartCell} cell
   */
  #firstRow(read, cell) {
    const labels = this.view.rows.map((row) => row.label);
    if (this.view.layout.grids.length === 1) {
      return read.length < labels.length ? labels.indexOf(cell.place.row.label) : 0;
    }
    const height = this.view.layout.grids[0].rows.length;
    const named = labels.indexOf(read[0][0].row);
    const isOne = read.length <= height && named === 0;
    return isOne ? Math.floor(labels.indexOf(cell.place.row.label) / height) * height : Math.max(named, 0);
  }
}
