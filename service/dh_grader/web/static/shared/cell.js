// A cell: an input, how the service reads its text, and its mark after a check.

import { h, visible } from "./dom.js";
import { mathml } from "./markup.js";
import { verdictName } from "./words/phrases.js";
import { worded } from "./words/words.js";

export const SIGNS = { correct: "✓", partial: "~", incorrect: "✗", unreadable: "?", missing: "–" };

/** @template {Front.CellPlace} Place */
export class Cell {
  #before = "";

  /**
   * `place` says where the cell is, and how screen readers name it (`spoken`). `owner` gets all events.
   *
   * @param {Place} place
   * @param {Front.CellOwner<Place>} owner
   */
  constructor(place, owner) {
    const { id, spoken, offers, isGiven } = place;
    this.place = place;
    this.owner = owner;
    /** @type {Front.Reading | null} */
    this.reading = null;
    /** @type {HTMLElement[]} */
    this.messages = [];
    this.shown = h("div", { class: "shown", id: `${id}-shown` });
    this.sign = h("span", { class: "sign" });
    this.echo = h("span", { class: "echo", "aria-hidden": "true" });
    this.input = h("input", {
      type: "text",
      id,
      autocomplete: "off",
      autocapitalize: "off",
      autocorrect: "off",
      spellcheck: "false",
      readonly: isGiven,
      list: offers ? `${id}-offers` : null,
      "aria-label": spoken,
      "aria-describedby": `${id}-shown`,
      oninput: () => this.#typed(),
      onscroll: () => this.#follow(),
      onfocus: () => this.owner.entered(this),
      onkeydown: (event) => this.owner.pressed(event, this),
      onpaste: (event) => this.owner.pasted(event, this),
      onbeforeinput: (event) => this.owner.beforeInput(event),
    });
    const entry = h("div", { class: "entry" }, this.echo, this.input, this.sign);
    this.element = h("td", {}, entry, this.shown);
    if (offers) entry.append(h("datalist", { id: `${id}-offers` }, ...offers.map((value) => h("option", { value }))));
  }

  get text() {
    return this.input.value;
  }

  /**
   * Replace the text without adding a step for undo.
   *
   * @param {string} text
   */
  put(text) {
    this.input.value = text;
    this.#changed();
  }

  #typed() {
    const before = this.#before;
    this.#changed();
    this.owner.typed(this, before);
  }

  #changed() {
    this.#before = this.text;
    const told = this.messages;
    this.mark(null);
    this.#underline(null);
    this.owner.changed(this, told);
  }

  /**
   * Show how the service reads the text; null for an empty cell.
   *
   * @param {Front.Reading | null} reading
   */
  understood(reading) {
    this.reading = reading;
    const error = reading?.error;
    this.element.classList.toggle("unread", Boolean(error));
    this.#showValidity();
    this.#underline(error?.span ?? null);
    this.shown.replaceChildren(...this.#readingShown(reading));
    this.owner.understood(this);
  }

  #showValidity() {
    const { verdict } = this.element.dataset;
    const isWrong = Boolean(verdict) && verdict !== "correct" && verdict !== "missing";
    if (isWrong || this.reading?.error) this.input.setAttribute("aria-invalid", "true");
    else this.input.removeAttribute("aria-invalid");
  }

  /** @param {Front.Reading | null} reading */
  #readingShown(reading) {
    if (!reading) return [];
    if (!reading.error) return [mathml(reading.mathml) ?? visible(reading.text)];
    const told = h("span", { class: "aloud" }, visible(reading.error.message));
    return [told, reading.error.suggestion ? this.repair(reading.error.suggestion) : worded("not read")];
  }

  /**
   * Return a button that replaces the text by a suggestion.
   *
   * @param {string} suggestion
   * @returns {HTMLElement}
   */
  repair(suggestion) {
    return h(
      "button",
      { type: "button", class: "repair", onclick: () => this.owner.repaired(this, suggestion) },
      h("span", { class: "aloud" }, worded("Write"), " "),
      h("span", { "aria-hidden": "true" }, "→ "),
      h("bdi", {}, visible(suggestion)),
    );
  }

  /**
   * Underline a piece of the text: from the first position to before the second, counted in code points.
   *
   * @param {[number, number] | null} span
   */
  #underline(span) {
    if (!span) return this.echo.replaceChildren();
    const characters = Array.from(this.text);
    /** @type {(from?: number, to?: number) => string} */
    const piece = (from, to) => characters.slice(from, to).join("");
    const to = Math.max(span[1], span[0] + 1);
    this.echo.replaceChildren(piece(0, span[0]), h("u", {}, piece(span[0], to) || " "), piece(to));
    this.#follow();
  }

  #follow() {
    this.echo.scrollLeft = this.input.scrollLeft;
  }

  /**
   * Show the mark of a report; null removes it.
   *
   * @param {Api.CellReport | null} report
   */
  mark(report) {
    const { spoken } = this.place;
    const verdict = report?.verdict;
    if (verdict) this.element.dataset.verdict = verdict;
    else delete this.element.dataset.verdict;
    this.sign.replaceChildren(
      ...(verdict
        ? [h("span", { "aria-hidden": "true" }, SIGNS[verdict]), h("span", { class: "aloud" }, verdictName(verdict))]
        : []),
    );
    this.input.setAttribute("aria-label", verdict ? `${spoken}: ${verdictName(verdict)}` : spoken);
    this.#showValidity();
    if (!verdict) this.#tie([]);
  }

  /**
   * Tie a message of a report to the cell, so that screen readers read it with the cell.
   *
   * @param {HTMLElement} item
   */
  tell(item) {
    item.id ||= `${this.place.id}-told-${this.messages.length}`;
    this.#tie([...this.messages, item]);
  }

  /** @param {HTMLElement[]} messages */
  #tie(messages) {
    this.messages = messages;
    this.input.setAttribute("aria-describedby", [this.shown, ...messages].map((each) => each.id).join(" "));
  }
}
