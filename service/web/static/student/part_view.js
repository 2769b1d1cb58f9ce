// A part of an exercise: its prompt, cells and report, and the line that shows how the current cell is read.

import { h, message, points, visible } from "../shared/dom.js";
import { gridsOf } from "./grid_view.js";
import { layoutOf } from "./kinds.js";
import { html, mathml } from "../shared/markup.js";
import { lostItems } from "./lost_points.js";
import { cellName, item } from "./messages.js";
import { blockOf, pair, placedFrom } from "../shared/pasted_block.js";
import { target, undoKey } from "../shared/keyboard.js";

// A text with one of these may hold several cells; the service decides.
const BETWEEN_CELLS = /[\n\t;|&,[]|\\\\/;
const SCRIPT = "unread_script";
const HELP = "Arrow keys and Enter move between cells. A table, a matrix or a block of cells can be pasted into one.";

export class PartView {
  changedAt = 0;
  /** @type {Front.PartCell | null} */
  #current = null;
  #quiet = false;

  /**
   * `host` is the exercise: service, previewer, history, announce, edited, check.
   *
   * @param {Api.Part} part
   * @param {Front.PartHost} host
   * @param {"h2" | "h3"} level
   */
  constructor(part, host, level) {
    this.part = part;
    this.host = host;
    this.layout = layoutOf(part);
    const { rows, elements } = gridsOf(this.layout, part, this, `part-${part.id}`);
    this.rows = rows;
    this.cells = rows.flatMap((row) => row.cells);
    this.choice = this.layout.choices ? this.#choiceField(this.layout.choices) : null;
    this.badge = h("span", { class: "badge", hidden: true });
    this.worth = h("span", { class: "points" }, `${points(0, part.points).split(" / ")[1]} points`);
    this.list = h("ul", { class: "messages", hidden: true });
    this.reading = h("p", { class: "reading" }, HELP);
    const id = `part-${part.id}-title`;
    this.element = h(
      "section",
      { class: "card part", "aria-labelledby": id },
      h("header", {}, h(level, { id }, part.title), this.badge, this.worth),
      h("div", { class: "prompt" }, ...html(part.prompt_html)),
      this.list,
      this.choice,
      h("div", { class: "grids" }, ...elements),
      this.reading,
    );
  }

  /** @param {Record<string, string>} choices */
  #choiceField(choices) {
    const options = Object.entries(choices).map(([value, text]) => h("option", { value }, text));
    return h(
      "select",
      { class: "choice", "aria-label": `${this.part.title}: option`, onchange: () => this.#chosen() },
      ...options,
    );
  }

  #chosen() {
    this.#showChoice();
    this.outdated();
    this.host.edited();
  }

  #showChoice() {
    const none = this.choice?.value === "none";
    for (const cell of this.cells) cell.input.disabled = none;
    this.element.classList.toggle("without-row", none);
  }

  /** The answer as the browser saves it. */
  get state() {
    return { cells: this.cells.map((cell) => cell.text), choice: this.choice?.value ?? "" };
  }

  /**
   * Fill in a saved answer. Return the changes as one step for undo.
   *
   * @param {Front.PartState} state
   */
  restore(state) {
    if (this.choice && [...this.choice.options].some((option) => option.value === state.choice)) {
      this.choice.value = state.choice;
      this.#showChoice();
    }
    return this.#fill(this.cells.map((cell, i) => [cell, state.cells[i] ?? ""]));
  }

  get isEmpty() {
    return this.cells.every((cell) => cell.text.trim() === "") && this.choice?.value !== "none";
  }

  /** The answer as it is posted. */
  get answer() {
    const { cells, choice } = this.state;
    return this.layout.answer(cells, choice);
  }

  /** @param {[Front.PartCell, string][]} pairs */
  #fill(pairs) {
    const changes = pairs.map(([cell, after]) => ({ target: cell, before: cell.text, after }));
    this.#quiet = true;
    for (const { target: cell, before, after } of changes) if (before !== after) cell.put(after);
    this.#quiet = false;
    return changes;
  }

  // The methods that the cells call.

  /** @param {Front.PartCell} cell @param {string} before */
  typed(cell, before) {
    this.host.history.note([{ target: cell, before, after: cell.text }], true);
  }

  /** @param {Front.PartCell} cell */
  changed(cell) {
    this.changedAt = performance.now();
    cell.place.row.outdated();
    this.outdated();
    this.host.previewer.ask(cell);
    if (!this.#quiet) this.host.edited();
  }

  /** @param {Front.PartCell} cell */
  entered(cell) {
    this.#current = cell;
    this.#showReading();
  }

  /** @param {Front.PartCell} cell */
  understood(cell) {
    if (cell === this.#current) this.#showReading(true);
  }

  /** Show below the grids how the current cell is read. */
  #showReading(aloud = false) {
    const cell = this.#current;
    const reading = cell?.text.trim() ? cell.reading : null;
    this.reading.classList.toggle("unread", Boolean(reading?.error));
    if (!cell || !reading) return this.reading.replaceChildren(HELP);
    const name = h("strong", {}, `${cell.place.spoken || this.part.title}: `);
    if (reading.error) {
      const { suggestion } = reading.error;
      this.reading.replaceChildren(
        name,
        ...message(reading.error.message),
        " ",
        suggestion ? cell.repair(suggestion) : "",
      );
      if (aloud) this.host.announce(`Not read: ${reading.error.message}`, 1200);
      return undefined;
    }
    const notes = reading.notes?.flatMap((note) => [" ", h("span", { class: "quiet" }, ...message(note.message))]) ??
      [];
    return this.reading.replaceChildren(name, mathml(reading.mathml) ?? visible(reading.text), ...notes);
  }

  /** @param {Front.PartCell} cell @param {string} suggestion */
  repaired(cell, suggestion) {
    this.host.history.note(this.#fill([[cell, suggestion]]));
    this.host.edited();
    this.focus(cell);
  }

  /** @param {Front.PartCell} cell */
  focus(cell) {
    cell.input.focus();
    cell.input.select();
  }

  /** @param {InputEvent} event */
  beforeInput(event) {
    if (event.inputType === "historyUndo") this.#undo(event, "undo");
    if (event.inputType === "historyRedo") this.#undo(event, "redo");
  }

  /** @param {KeyboardEvent} event @param {Front.PartCell} cell */
  pressed(event, cell) {
    const undone = undoKey(event);
    if (undone) return this.#undo(event, undone);
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) return this.host.check();
    const next = target(event, cell, this.rows.map((row) => row.cells));
    if (event.key === "Enter") event.preventDefault();
    if (!next) return undefined;
    event.preventDefault();
    return this.focus(next);
  }

  /** @param {Event} event @param {Front.Direction} direction */
  #undo(event, direction) {
    event.preventDefault();
    const cell = this.host.history[direction]();
    if (cell) cell.input.focus();
    else this.host.announce(direction === "undo" ? "Nothing to undo" : "Nothing to redo");
  }

  // Pasted texts. The service decides if a text is a table, and which cells it has.

  /** @param {ClipboardEvent} event @param {Front.PartCell} cell */
  async pasted(event, cell) {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    if (!BETWEEN_CELLS.test(text.trim())) return;
    event.preventDefault();
    let grid;
    try {
      const context = this.host.context();
      grid = await this.host.service.preview({ ...context, part: this.part.id, text, quantity: cell.place.quantity });
    } catch (error) {
      this.host.failed(error);
    }
    const block = blockOf(text);
    const pairs = (grid?.rows && this.#placed(grid.rows, cell)) ?? (block && this.#placedBlock(block, cell));
    if (pairs) {
      this.host.history.note(this.#fill(pairs));
      this.host.edited();
      this.focus(pairs[0][0]);
      this.#say(`The pasted text filled ${pairs.length} cells. Press Ctrl+Z to undo.`, grid?.notes);
      return;
    }
    const misfit = grid?.rows
      ? `The pasted text has ${grid.rows.length} rows, which do not fit here.`
      : grid?.error?.message;
    const told = misfit && !grid?.ok ? `Not read as a table or matrix: ${misfit}` : misfit;
    // Joined into one line, a script or several lines would make the cell unusable.
    if (told && (grid?.error?.code === SCRIPT || text.trim().includes("\n"))) return this.#say(told);
    const before = cell.text;
    cell.input.setRangeText(
      text.replace(/\s*\n\s*/g, " ").trim(),
      cell.input.selectionStart ?? 0,
      cell.input.selectionEnd ?? 0,
      "end",
    );
    const after = cell.text;
    cell.put(after);
    this.host.history.note([{ target: cell, before, after }]);
    if (told) this.#say(told);
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
    const rows = this.rows.map((row) => row.cells);
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
    const rows = this.rows.filter((row) => row.grid === cell.place.row.grid).map((row) => row.cells);
    return placedFrom(cell, rows, block);
  }

  /**
   * Return the first row that a pasted grid fills: the row with its first label, or, for a single matrix without a
   * name, the first row of the cell's matrix.
   *
   * @param {Api.PreviewCell[][]} read
   * @param {Front.PartCell} cell
   */
  #firstRow(read, cell) {
    const labels = this.rows.map((row) => row.label);
    if (this.layout.grids.length === 1) return read.length < labels.length ? labels.indexOf(cell.place.row.label) : 0;
    const height = this.layout.grids[0].rows.length;
    const named = labels.indexOf(read[0][0].row);
    const isOne = read.length <= height && named === 0;
    return isOne ? Math.floor(labels.indexOf(cell.place.row.label) / height) * height : Math.max(named, 0);
  }

  /** @param {string} text @param {Api.PreviewNote[]} [notes] */
  #say(text, notes = []) {
    const told = notes?.map((note) => note.message) ?? [];
    this.reading.classList.remove("unread");
    this.reading.replaceChildren(...message([text, ...told].join(" ")));
    this.#current = null;
    this.host.announce(text);
  }

  // The report.

  /**
   * Show the part's report: marks on rows and cells, and messages.
   *
   * @param {Api.PartReport} report
   */
  showReport(report) {
    const rows = new Map(report.rows.map((row) => [row.label, row]));
    for (const view of this.rows) {
      const row = rows.get(view.label);
      view.mark(row ?? null, row ? this.#items(row, view) : []);
      rows.delete(view.label);
    }
    const more = [...rows.values()].flatMap((row) => [...row.feedback, ...row.cells.flatMap((cell) => cell.feedback)]);
    const items = [...report.feedback, ...more].map((each) => item(each, { verdict: report.verdict }));
    if (report.follow_through) {
      items.unshift(item({ severity: "note", message: "Counted with your own earlier answer." }));
    }
    items.push(...lostItems(report));
    this.list.replaceChildren(...items);
    this.list.hidden = items.length === 0;
    this.setVerdict(report.verdict);
    this.worth.textContent = `${points(report.points, report.max_points)} points`;
  }

  /** @param {Api.RowReport} row @param {Front.RowView} view */
  #items(row, view) {
    const own = row.feedback.map((each) => item(each, { verdict: row.verdict }));
    const ofCells = row.cells.flatMap((cell) => {
      const target = view.cells.find((each) => each.place.label === cell.label);
      const repair = target ? (/** @type {string} */ suggestion) => target.repair(suggestion) : null;
      const place = view.cells.length > 1 ? cellName(cell.label) : "";
      return cell.feedback.map((each) => item(each, { place, verdict: cell.verdict, repair }));
    });
    return [...own, ...ofCells];
  }

  /** @param {Api.Verdict | null} verdict */
  setVerdict(verdict) {
    this.badge.hidden = !verdict;
    this.badge.textContent = verdict ?? "";
    if (verdict) this.badge.dataset.verdict = verdict;
    this.element.classList.remove("outdated");
  }

  /** Fade the report, because the answer has changed since. */
  outdated() {
    if (!this.badge.hidden) this.element.classList.add("outdated");
  }

  clearReport() {
    this.setVerdict(null);
    this.list.hidden = true;
    for (const row of this.rows) row.mark(null);
    this.worth.textContent = `${points(0, this.part.points).split(" / ")[1]} points`;
  }
}
