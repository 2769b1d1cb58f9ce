// The form of an exercise beyond single parts: the unit of angles, folded parts, the rail, keys for touch screens, and
// the focus on the first slip.

import { KeyBar } from "./key_bar.js";
import { Rail } from "./rail.js";
import { Tools } from "./tools.js";
import { worded } from "../../shared/words/words.js";

export class Form {
  /** @type {Front.PartView[]} */
  parts = [];
  /** @type {Rail} */
  rail;
  /** @type {Front.Slip | null} */
  #slip = null;
  // Typeset formulas, hints and their style sheet may arrive after the report, and move the slip and its message.
  #sizes = new ResizeObserver(() => this.keepSlipInView());

  /** @param {Front.FormHost} host the exercise @param {() => void} clear */
  constructor(host, clear) {
    this.host = host;
    this.tools = new Tools(host, () => this.#unitChanged(), clear);
    this.keys = new KeyBar(host.exercise.symbols, () => this.parts[0].undo("undo"));
  }

  /** Take over the parts after they have been created. @param {Front.PartView[]} parts */
  begin(parts) {
    this.parts = parts;
    this.rail = new Rail(parts);
    const { folded } = this.host.store;
    for (const part of parts) part.setFolded(folded.includes(part.part.id));
  }

  get angleUnit() {
    return /** @type {Api.AngleUnit} */ (this.tools.unit.value);
  }

  /** Read angles without a unit in another unit, and check again. @param {Api.AngleUnit} unit */
  useUnit(unit) {
    this.readIn(unit);
    this.host.check();
  }

  /** Read angles without a unit in another unit. @param {Api.AngleUnit} unit */
  readIn(unit) {
    this.tools.unit.value = unit;
    this.#unitChanged();
  }

  #unitChanged() {
    for (const part of this.parts) part.readAgain();
    this.host.edited();
  }

  /** Remember which parts are folded. */
  folded() {
    this.host.store.saveFolded(this.parts.filter(({ body }) => body.hidden).map(({ part }) => part.id));
  }

  /** Show a cell of any part, and focus it. @param {Front.PartCell} cell */
  showCell(cell) {
    this.parts.find((part) => part.cells.includes(cell))?.reveal(cell);
    cell.input.focus();
  }

  /** The text for screen readers if there is no answer to check. */
  get firstStep() {
    return this.parts.every(({ marks }) => marks)
      ? worded("First mark the cell with the slip.")
      : worded("Nothing is filled in yet.");
  }

  /**
   * Focus the first wrong cell, or else the first missing one, and bring the cell and its first message into view.
   * Return the text for screen readers about this cell.
   *
   * @param {Front.PartView[]} parts
   */
  leadToSlip(parts) {
    this.leaveSlip();
    const slip = this.#slip = firstSlip(parts);
    if (!slip) return "";
    slip.field.focus({ preventScroll: true });
    this.keepSlipInView();
    for (const around of [slip.field.closest("table"), slip.field.closest(".part")]) {
      if (around) this.#sizes.observe(around);
    }
    return worded("First slip: {cell}. {message}", {
      cell: slip.name,
      message: slip.message?.querySelector("p")?.textContent ?? "",
    });
  }

  /** Keep the first slip in view no longer, because the student writes. */
  leaveSlip() {
    this.#slip = null;
    this.#sizes.disconnect();
  }

  /** Bring the first slip and its message into view, unless the student has gone on to another cell. */
  keepSlipInView() {
    if (!this.#slip?.field.matches(":focus")) return;
    const { field, message } = this.#slip;
    // The cell first, so that its table is scrolled sideways; and last, in case that both do not fit.
    for (const each of [field, message, field]) each?.scrollIntoView({ block: "nearest", inline: "nearest" });
  }
}

/** Show and return the first wrong place, or else the first missing cell. @param {Front.PartView[]} parts */
function firstSlip(parts) {
  for (const isMissing of [false, true]) {
    for (const part of parts) {
      const slip = part.firstSlip(isMissing);
      if (slip) return slip;
    }
  }
  return null;
}
