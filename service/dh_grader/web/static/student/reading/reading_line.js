// The line below the cells of a part: what cannot be read and why, and what the cell itself cannot show.

import { h, visible } from "../../shared/dom.js";
import { mathml } from "../../shared/markup.js";
import { typeset, typesetMessage } from "../../typeset/names.js";
import { worded } from "../../shared/words/words.js";

// The reading of a longer text may be cut off in its cell.
const LONG = 40;
/** Instructions for the columns of a part, by the kind of part. @type {Record<string, string>} */
const GUIDES = {
  frames: worded(
    "Axis: the number of a joint. z and x: a direction, such as +y or [0, 1, 0]. o: the origin in the base frame. All joint variables are 0.",
  ),
};
/** @param {Pick<Api.Part, "kind">} part */
const help = ({ kind }) => [
  GUIDES[kind] ? `${GUIDES[kind]} ` : "",
  h("span", { class: "with-keyboard" }, worded("Arrow keys and Enter move between cells."), " "),
  worded("A table, a matrix or a block of cells can be pasted into one."),
];

export class ReadingLine {
  /** @type {Front.PartCell | null} */
  #current = null;

  /**
   * @param {Api.Part} part
   * @param {Set<string>} symbols that the exercise declares
   * @param {Front.PartHost["announce"]} announce
   */
  constructor(part, symbols, announce) {
    this.part = part;
    this.element = h("p", { class: "reading" }, ...help(part));
    this.symbols = symbols;
    this.announce = announce;
  }

  /** From now on, show how this cell is read. @param {Front.PartCell} cell */
  enter(cell) {
    this.#current = cell;
    this.#show(cell);
  }

  /** Show the new reading of a cell, if it is the current one. @param {Front.PartCell} cell */
  understood(cell) {
    if (cell === this.#current) this.#show(cell, true);
  }

  /** @param {Front.PartCell} cell */
  #show(cell, aloud = false) {
    const reading = cell.text.trim() ? cell.reading : null;
    const isTold = cell.messages.length > 0;
    this.element.classList.toggle("unread", Boolean(reading?.error) && !isTold);
    // The report below the row says why the cell is not read.
    if (!reading || (reading.error && isTold)) return this.element.replaceChildren(...help(this.part));
    const name = h("strong", {}, ...typeset(visible(`${cell.place.spoken || this.part.title}: `)));
    if (reading.error) {
      const { suggestion, message: why } = reading.error;
      this.element.replaceChildren(
        name,
        ...typesetMessage(why, this.symbols),
        " ",
        suggestion ? cell.repair(suggestion) : "",
      );
      if (aloud) this.announce(worded("Not read: {reason}", { reason: why }), 1200);
      return undefined;
    }
    const notes = reading.notes?.flatMap((
      note,
    ) => [" ", h("span", { class: "quiet" }, ...typesetMessage(note.message, this.symbols))]) ??
      [];
    // A cell with a short text shows itself how it is read.
    const isLong = cell.text.length > LONG;
    if (!isLong && !notes.length) return this.element.replaceChildren(...help(this.part));
    const whole = isLong ? mathml(reading.mathml) ?? visible(reading.text) : "";
    return this.element.replaceChildren(name, whole, ...notes);
  }

  /** Show a text until the student enters the next cell. @param {string} text @param {Api.PreviewNote[]} [notes] */
  say(text, notes = []) {
    this.element.classList.remove("unread");
    this.element.replaceChildren(
      ...typesetMessage([text, ...notes.map((note) => note.message)].join(" "), this.symbols),
    );
    this.#current = null;
    this.announce(text);
  }
}
