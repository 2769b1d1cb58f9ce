// Keys for touch screens, below the row with the focus: the symbols of the exercise, and signs that phones hide.

import { h } from "../../shared/dom.js";
import { worded } from "../../shared/words/words.js";

const SIGNS = ["π", "°", "−", "/", "*", "(", ")", "sin(", "cos(", "θ", "α", "d"];
/** @type {Record<string, string>} */
const GREEK = { theta: "θ", alpha: "α", beta: "β", gamma: "γ", phi: "φ", psi: "ψ" };
const SUBSCRIPTS = "₀₁₂₃₄₅₆₇₈₉";

/**
 * Return the name of a symbol as a key shows it, such as θ₁ for theta1.
 *
 * @param {string} name
 */
export function face(name) {
  const [, letters, digits] = name.match(/^([A-Za-z]+?)_?(\d+)$/) ?? [null, name, ""];
  return (GREEK[letters] ?? letters) + Array.from(digits, (digit) => SUBSCRIPTS[Number(digit)]).join("");
}

/**
 * Return the texts that keys write: symbols of the cell's quantity, then all other symbols, then signs.
 *
 * @param {Pick<Api.ExerciseSymbol, "name" | "kind">[]} symbols
 * @param {Api.Quantity} quantity
 */
export function keysOf(symbols, quantity) {
  const names = [
    ...symbols.filter(({ kind }) => kind === quantity),
    ...symbols.filter(({ kind }) => kind !== quantity),
  ].map(({ name }) => name);
  return [...names, ...SIGNS.filter((sign) => !names.includes(sign))];
}

export class KeyBar {
  /** @type {Front.PartCell | null} */
  #cell = null;
  #touch = matchMedia("(pointer: coarse)");

  /**
   * @param {Api.ExerciseSymbol[]} symbols
   * @param {() => void} undo
   */
  constructor(symbols, undo) {
    this.symbols = symbols;
    this.undo = undo;
    this.keys = h("div", { class: "keys", role: "toolbar", "aria-label": worded("Symbols") });
    // A tap must not take the focus from the cell, or the phone's own keyboard would close.
    this.keys.addEventListener("mousedown", (event) => event.preventDefault());
    this.place = h("td", {}, this.keys);
    this.row = h("tr", { class: "notes key-row" });
  }

  /**
   * Show the keys below the row of a cell; null hides them.
   *
   * @param {Front.PartCell | null} cell
   */
  show(cell) {
    const before = this.#cell;
    this.#cell = cell;
    if (!cell || !this.#touch.matches) return this.row.remove();
    const { row, quantity } = cell.place;
    if (before?.place.quantity !== quantity || !this.keys.childNodes.length) this.#fill(quantity);
    if (this.row.previousElementSibling === row.notes) return undefined;
    this.place.colSpan = row.cells.length;
    this.row.replaceChildren(h("td"), this.place, h("td", { class: "worth" }));
    return row.notes.after(this.row);
  }

  /** @param {Api.Quantity} quantity */
  #fill(quantity) {
    const undo = h("button", { type: "button", "aria-label": worded("Undo"), onclick: this.undo }, "↶");
    const keys = keysOf(this.symbols, quantity).map((text) =>
      h("button", { type: "button", onclick: () => this.#write(text) }, face(text))
    );
    this.keys.replaceChildren(undo, ...keys);
  }

  /** Write at the caret, as if the text was typed. @param {string} text */
  #write(text) {
    const input = this.#cell?.input;
    if (!input) return;
    input.focus();
    input.setRangeText(text, input.selectionStart ?? 0, input.selectionEnd ?? 0, "end");
    input.dispatchEvent(
      new InputEvent("input", { inputType: "insertText", data: text, bubbles: true, composed: true }),
    );
  }
}
