// A plain number in an angle cell that is read in radians, but looks like degrees: 90, -90 or 180.

import { h } from "../../shared/dom.js";
import { worded } from "../../shared/words/words.js";

const NUMBER = /^[+\-−]?\s*(\d+(?:[.,]\d+)?)$/;
// More than a whole turn in radians.
const LEAST = 7;

/**
 * Return the number in a text, without its sign, if it looks like degrees and is read in radians; or else null.
 *
 * @param {string} text
 * @param {Api.Quantity} quantity
 * @param {Api.AngleUnit} unit
 */
export function bareRadians(text, quantity, unit) {
  const [, number] = NUMBER.exec(text.trim()) ?? [];
  if (!number || quantity !== "angle" || unit !== "radians") return null;
  return Number(number.replace(",", ".")) >= LEAST ? number : null;
}

/** @param {string} number */
export const inRadians = (number) =>
  worded("{number} is read as {number} rad. For degrees, write {number}°, or read all plain angles as degrees.", {
    number,
  });

/** Warns below the row of the last cell that holds such a number. */
export class RadiansWarning {
  /** @type {Front.PartCell | null} */
  #cell = null;

  /**
   * @param {NonNullable<Front.PartHost["form"]>} form
   * @param {Front.PartHost["announce"]} announce
   */
  constructor(form, announce) {
    this.form = form;
    this.announce = announce;
    this.text = h("p");
    const button = h(
      "button",
      { type: "button", class: "quiet-button", onclick: () => this.#inDegrees() },
      worded("Read angles as degrees"),
    );
    this.element = h("li", { class: "in-radians" }, this.text, button);
  }

  /** Show or remove the warning after a cell has been read. @param {Front.PartCell} cell */
  understood(cell) {
    const { row, quantity } = cell.place;
    const number = cell.reading && bareRadians(cell.text, quantity, this.form.angleUnit);
    if (number) {
      cell.shown.append(" rad");
      this.#remove();
      this.#cell = cell;
      this.text.textContent = inRadians(number);
      row.addNote(this.element);
      if (cell.input.matches(":focus")) this.announce(this.text.textContent, 1200);
    } else if (cell === this.#cell) this.#remove();
  }

  #remove() {
    this.#cell?.place.row.removeNote(this.element);
    this.#cell = null;
  }

  #inDegrees() {
    const cell = this.#cell;
    this.form.readIn("degrees");
    cell?.input.focus();
    this.announce(worded("Angles without a unit are read as degrees."));
  }
}
