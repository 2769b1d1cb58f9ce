// A part of an exercise: its prompt, cells and report, and the line that shows how the current cell is read.

import { h, visible } from "../shared/dom.js";
import { layoutOf } from "./kinds.js";
import { html } from "../shared/markup.js";
import { lostItems } from "./report/lost_points.js";
import { followedItems, item, messagesOf, outdate } from "./messages.js";
import { PartResult } from "./report/part_result.js";
import { cellsInWords } from "./report/places.js";
import { RadiansWarning } from "./reading/bare_radians.js";
import { PartGrids } from "./form/part_grids.js";
import { pasteBox } from "./form/paste_box.js";
import { Pasting } from "./form/pasting.js";
import { proposal } from "./form/proposals.js";
import { ReadingLine } from "./reading/reading_line.js";
import { SlipMarks } from "./slip/slip_marks.js";
import { target, undoKey } from "../shared/keyboard.js";
import { typeset } from "../typeset/names.js";
import { nothingTo, optionName } from "../shared/words/phrases.js";

export class PartView {
  changedAt = 0;
  /** @type {Front.Told[]} the messages of the report, with their places */
  told = [];
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
    this.symbols = new Set(host.exercise?.symbols.map((symbol) => symbol.name));
    this.layout = layoutOf(part);
    this.grids = new PartGrids(this.layout, part, this);
    this.rows = this.grids.rows;
    this.cells = this.grids.cells;
    this.pasting = new Pasting(this);
    const { choices, marks } = this.layout;
    this.choice = choices ? this.#choiceField(choices) : null;
    this.marks = marks ? new SlipMarks(this.layout.grids[0], marks, this.symbols, () => this.#chosen()) : null;
    this.mended = h("div", { class: "grids", hidden: Boolean(marks) }, ...this.grids.elements);
    this.result = new PartResult(part);
    this.list = h("ul", { class: "messages", hidden: true });
    this.line = new ReadingLine(part, this.symbols, (text, pause) => host.announce(text, pause));
    this.warning = host.form ? new RadiansWarning(host.form, (text, pause) => host.announce(text, pause)) : null;
    this.reading = this.line.element;
    const id = `part-${part.id}-title`;
    this.body = h(
      "div",
      { class: "body", id: `part-${part.id}-body` },
      h("div", { class: "prompt" }, ...html(part.prompt_html)),
      this.list,
      this.choice ?? this.marks?.element,
      this.grids.tabs?.element,
      this.mended,
      this.reading,
      host.form && this.cells.length > 1 ? pasteBox(part, (text) => this.pasting.whole(text, this.grids.first)) : null,
    );
    this.fold = h(
      "button",
      {
        type: "button",
        class: "fold",
        "aria-expanded": "true",
        "aria-controls": this.body.id,
        onclick: () => this.#fold(!this.body.hidden),
      },
      ...typeset(visible(part.title)),
    );
    this.element = h(
      "section",
      { class: "card part", "aria-labelledby": id },
      h("header", {}, h(level, { id }, this.fold), ...this.result.elements),
      this.body,
    );
    if (host.form) this.#prefill();
  }

  /** Write the texts that the form fills in, such as the last row of a homogeneous matrix. */
  #prefill() {
    this.#fill(this.cells.filter((cell) => cell.place.prefill).map((cell) => [cell, cell.place.prefill ?? ""]));
    this.changedAt = 0;
  }

  // The visible cells of the part, and its progress.

  /** Fold or unfold the part. @param {boolean} isFolded */
  setFolded(isFolded) {
    this.body.hidden = isFolded;
    this.fold.setAttribute("aria-expanded", String(!isFolded));
  }

  /** @param {boolean} isFolded */
  #fold(isFolded) {
    if (isFolded === this.body.hidden) return;
    this.setFolded(isFolded);
    this.host.form?.folded();
  }

  /** Show the part, and focus its first cell. */
  jump() {
    this.#fold(false);
    this.element.scrollIntoView({ block: "start" });
    this.grids.first.input.focus({ preventScroll: true });
  }

  /** Unfold the part and choose the tab, so that the cell is visible. @param {Front.PartCell} cell */
  reveal(cell) {
    this.#fold(false);
    this.grids.show(cell);
  }

  /**
   * The progress: the verdict, unless the answer has changed since the report, and how much is filled.
   *
   * @returns {Front.Progress}
   */
  get progress() {
    return { verdict: this.result.verdict, ...this.grids.progress };
  }

  /** @param {Record<string, string>} choices */
  #choiceField(choices) {
    const options = Object.entries(choices).map(([value, text]) => h("option", { value }, text));
    return h(
      "select",
      { class: "choice", "aria-label": optionName(this.part.title), onchange: () => this.#chosen() },
      ...options,
    );
  }

  #chosen() {
    this.#showChoice();
    this.outdated();
    this.host.edited();
  }

  #showChoice() {
    this.marks?.show(null);
    this.mended.hidden = Boolean(this.marks?.isUntouched(this.grids.texts));
    const none = this.choice?.value === "none";
    for (const cell of this.cells) cell.input.disabled = none;
    this.element.classList.toggle("without-row", none);
  }

  /** The answer as the browser saves it. */
  get state() {
    return { cells: this.grids.texts, choice: (this.choice ?? this.marks)?.value ?? "" };
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
    const saved = this.cells.map((_, i) => state.cells[i] ?? "");
    const texts = this.host.form ? this.grids.shown(saved) : saved;
    const changes = this.#fill(this.cells.map((cell, i) => [cell, texts[i]]));
    if (this.marks) {
      this.marks.value = state.choice;
      this.#showChoice();
    }
    return changes;
  }

  get isEmpty() {
    return this.choice?.value !== "none" && !this.marks?.value && this.state.cells.every((text) => text.trim() === "");
  }

  /** The answer as it is posted. */
  get answer() {
    const { cells, choice } = this.state;
    return this.layout.answer(cells, choice);
  }

  /** @param {[Front.PartCell, string][]} pairs */
  #fill(pairs) {
    const allowed = pairs.filter(([{ place }, after]) => !place.isGiven || after === place.prefill);
    const changes = allowed.map(([cell, after]) => ({ target: cell, before: cell.text, after }));
    this.#quiet = true;
    for (const { target: cell, before, after } of changes) if (before !== after) cell.put(after);
    this.#quiet = false;
    this.grids.markTabs();
    return changes;
  }

  /** Read all cells again, in another unit. The report is out of date, because it is about the earlier unit. */
  readAgain() {
    this.outdated();
    for (const cell of this.cells) this.#ask(cell);
  }

  /** Show how the service reads a cell, unless the form has filled in its text. @param {Front.PartCell} cell */
  #ask(cell) {
    const isPrefilled = Boolean(this.host.form) && cell.text !== "" && cell.text === cell.place.prefill;
    cell.element.classList.toggle("prefilled", isPrefilled);
    if (isPrefilled) cell.understood(null);
    else this.host.previewer.ask(cell);
  }

  /** Write texts into cells as one step for undo. @param {[Front.PartCell, string][]} pairs */
  write(pairs) {
    this.host.history.note(this.#fill(pairs));
    this.host.edited();
  }

  // The methods that the cells call.

  /** @param {Front.PartCell} cell @param {string} before */
  typed(cell, before) {
    this.host.history.note([{ target: cell, before, after: cell.text }], true);
  }

  /** @param {Front.PartCell} cell @param {HTMLElement[]} told the messages that were on it */
  changed(cell, told) {
    this.changedAt = performance.now();
    const { row } = cell.place;
    row.outdated();
    const isOn = (/** @type {Front.Topic} */ place) => place.row === row.label && !place.cell;
    for (const { element, place } of this.told) if (told.includes(element) || isOn(place)) outdate(element);
    this.outdated();
    this.#ask(cell);
    if (this.#quiet) return;
    this.grids.markTabs();
    this.host.edited();
  }

  /** @param {Front.PartCell} cell */
  entered(cell) {
    this.line.enter(cell);
    this.host.form?.keys.show(cell);
  }

  /** @param {Front.PartCell} cell */
  understood(cell) {
    this.line.understood(cell);
    this.warning?.understood(cell);
  }

  /** @param {Front.PartCell} cell @param {string} suggestion */
  repaired(cell, suggestion) {
    this.write([[cell, suggestion]]);
    this.focus(cell);
  }

  /** @param {Front.PartCell} cell */
  focus(cell) {
    this.reveal(cell);
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
    const next = this.grids.afterTab(event, cell) ?? target(event, cell, this.rows.map((row) => row.cells));
    if (event.key === "Enter") event.preventDefault();
    if (!next) return undefined;
    event.preventDefault();
    return this.focus(next);
  }

  /** @param {Event} event @param {Front.Direction} direction */
  #undo(event, direction) {
    event.preventDefault();
    this.undo(direction);
  }

  /** @param {Front.Direction} direction */
  undo(direction) {
    const cell = this.host.history[direction]();
    if (cell) this.host.form?.showCell(cell);
    else this.host.announce(nothingTo(direction));
  }

  /** @param {ClipboardEvent} event @param {Front.PartCell} cell */
  pasted(event, cell) {
    this.pasting.pasted(event, cell);
  }

  // The report.

  /**
   * Show the part's report: marks on rows and cells, and messages.
   *
   * @param {Api.PartReport} report
   */
  showReport(report) {
    for (const cell of this.cells) cell.mark(null);
    this.told = [];
    const rows = new Map(report.rows.map((row) => [row.label, row]));
    for (const view of this.rows) {
      const row = rows.get(view.label);
      view.mark(row ?? null, row ? this.#items(row, view) : []);
      rows.delete(view.label);
    }
    this.marks?.show(rows.get("marked")?.verdict ?? null);
    const options = { verdict: report.verdict, rows: report.rows };
    const items = messagesOf(report.feedback, rows.values()).map(([each, place]) =>
      this.#item(each, this.#at(each), options, place)
    );
    items.push(...lostItems(report, this.symbols));
    this.list.replaceChildren(...followedItems(report), ...items);
    this.list.hidden = items.length === 0;
    this.#showResult(report);
    this.grids.markTabs();
  }

  /**
   * Return the list item of a message, tied to its cells, with a button if the form has a proposal for the message.
   *
   * @param {Api.Feedback} feedback
   * @param {Front.PartCell[]} cells
   * @param {Parameters<typeof item>[1]} options
   * @param {Front.Topic} [at]
   */
  #item(feedback, cells, options, { row, cell } = {}) {
    const made = item(feedback, { ...options, symbols: this.symbols, action: proposal(this, feedback, cells) });
    this.told.push({ element: made, feedback, place: { row, cell } });
    for (const cell of cells) cell.tell(made);
    return made;
  }

  /** Return the cells at the places of a message. @param {Api.Feedback} feedback */
  #at({ places = [] }) {
    const isAt = (/** @type {Front.PartCell} */ { place }) =>
      places.some(({ row, cell }) => row === place.row.label && cell === place.label);
    return this.cells.filter(isAt);
  }

  /**
   * Show the first wrong cell or mark, or, if `isMissing`, the first missing cell. Return it with its first message.
   *
   * @returns {Front.Slip | null}
   */
  firstSlip(isMissing = false) {
    const verdicts = isMissing ? ["missing"] : ["incorrect", "partial", "unreadable"];
    const first = /** @type {HTMLElement | null} */ (this.list.firstElementChild);
    const mark = isMissing ? null : this.marks?.wrong;
    if (mark) {
      this.#fold(false);
      return { field: mark, name: mark.textContent ?? "", message: first };
    }
    const isSlip = (/** @type {Front.PartCell} */ cell) => verdicts.includes(cell.element.dataset.verdict ?? "");
    const cell = this.cells.find((each) => isSlip(each) && this.grids.isBegun(each));
    if (!cell) return null;
    this.reveal(cell);
    const message = cell.messages[0] ?? cell.place.row.list.firstElementChild ?? first;
    return { field: cell.input, name: cell.input.ariaLabel ?? "", message };
  }

  /** @param {Api.RowReport} row @param {Front.RowView} view */
  #items(row, view) {
    const own = row.feedback.map((each) => this.#item(each, [], { verdict: row.verdict }, { row: row.label }));
    /** @type {Map<string, [Api.Feedback, Api.CellReport[]]>} */
    const told = new Map();
    for (const cell of row.cells) {
      for (const each of cell.feedback) {
        // A suggestion is the repaired text of one cell.
        const key = JSON.stringify([cell.verdict, { ...each, span: null }, each.suggestion ? cell.label : ""]);
        told.set(key, [each, [...(told.get(key)?.[1] ?? []), cell]]);
      }
    }
    const ofCells = [...told.values()].map(([each, reports]) => {
      const labels = reports.map(({ label }) => label);
      const cells = view.cells.filter(({ place }) => labels.includes(place.label));
      const repair = cells.length === 1 ? (/** @type {string} */ suggestion) => cells[0].repair(suggestion) : null;
      const place = view.cells.length > 1 ? cellsInWords(labels) : "";
      return this.#item(each, cells, { place, verdict: reports[0].verdict, repair }, {
        row: row.label,
        cell: labels[0],
      });
    });
    return [...own, ...ofCells];
  }

  /** @param {Api.PartReport | null} report */
  #showResult(report) {
    this.result.show(report);
    this.element.classList.remove("outdated");
  }

  /** Fade the report, because the answer has changed since the report. */
  outdated() {
    if (this.result.outdated()) this.element.classList.add("outdated");
  }

  clearReport() {
    this.#showResult(null);
    this.list.hidden = true;
    for (const row of this.rows) row.mark(null);
    this.marks?.show(null);
    this.grids.markTabs();
  }
}
