// Saves answers in the browser, and packs them into links. A browser without storage is no error.

import { worded } from "./words/words.js";

const PREFIX = "dh-grader";
// The fragment of an address is never sent to a server.
const NAME = "#answers=";
const LONGEST = 60_000;

const UNSAVED = worded("This browser cannot save your answers: a reload loses them");
const UNDECIDED = worded("Not saved yet: choose above which answers to keep");

/**
 * The saved answers to one exercise of one service. All tabs share them: `save` never overwrites what another tab has
 * saved since this one loaded or saved the answers.
 */
export class Store {
  /** The sentence for the student if the answers were not saved. */
  unsaved = UNSAVED;
  /** The ids of the parts that this element shows; null for all. @type {string[] | null} */
  parts = null;
  // The saved answers as this tab knows them.
  #seen = "";
  #stop = new AbortController();

  /** @param {string} base @param {string} exercise */
  constructor(base, exercise) {
    this.name = `${PREFIX}:${base}:${exercise}`;
  }

  /** Call `changed` whenever another tab has changed the answers. @param {() => void} changed */
  listen(changed) {
    const { signal } = this.#stop;
    addEventListener("storage", ({ key }) => key === this.name && this.isChanged && changed(), { signal });
    // A page that slept has missed the events. If nothing is saved at all, the browser has cleared its storage.
    for (const name of ["pageshow", "focus"]) {
      addEventListener(name, () => this.#saved && this.isChanged && changed(), { signal });
    }
  }

  close() {
    this.#stop.abort();
  }

  load() {
    const saved = this.#saved;
    this.#seen = this.#own(saved);
    return saved;
  }

  /** True if another tab has changed the answers since this one loaded or saved them. */
  get isChanged() {
    return this.#own(this.#saved) !== this.#seen;
  }

  /** @returns {Front.Answers | null} */
  get #saved() {
    return saved(this.name);
  }

  /** Return the answers to the parts of this element as a text; empty if there are none. @param {Front.Answers | null} answers */
  #own(answers) {
    const ids = (this.parts ?? Object.keys(answers?.parts ?? {})).filter((id) =>
      Object.hasOwn(answers?.parts ?? {}, id)
    );
    return answers && ids.length ? JSON.stringify([answers.unit, ids.map((id) => [id, answers.parts[id]])]) : "";
  }

  /**
   * Save the answers; null deletes them. Return false if the browser does not allow it, or if another tab has changed
   * the answers: then these answers are set aside.
   *
   * @param {Front.Answers | null} answers
   */
  save(answers) {
    const before = this.#saved;
    const theirs = this.#own(before);
    // Nothing is lost if the other tab has emptied all cells.
    if (theirs && theirs !== this.#seen && theirs !== this.#own(answers)) {
      if (answers) this.setAside(answers);
      this.unsaved = UNDECIDED;
      return false;
    }
    this.unsaved = UNSAVED;
    // Other elements may show other parts of the exercise.
    const others = Object.entries(before?.parts ?? {}).filter(([id]) => this.parts && !this.parts.includes(id));
    const parts = Object.fromEntries([...others, ...Object.entries(answers?.parts ?? {})]);
    const unit = answers?.unit ?? before?.unit ?? "radians";
    if (!put(this.name, others.length || answers ? { unit, parts } : null)) return false;
    this.#seen = this.#own(answers);
    return true;
  }

  /** Let the next `save` replace the answers of another tab, and set these aside. */
  keepMine() {
    const theirs = this.load();
    this.setAside(theirs);
  }

  /** Keep answers beside those that are saved; null forgets them. @param {Front.Answers | null} answers */
  setAside(answers) {
    put(`${this.name}:set-aside`, answers);
  }

  /** The answers that were set aside, because two tabs had changed them. */
  get aside() {
    return saved(`${this.name}:set-aside`);
  }

  /** The ids of the folded parts. @returns {unknown[]} */
  get folded() {
    try {
      const ids = JSON.parse(localStorage.getItem(`${this.name}:folded`) ?? "[]");
      return Array.isArray(ids) ? ids : [];
    } catch {
      return [];
    }
  }

  /** @param {string[]} ids */
  saveFolded(ids) {
    try {
      localStorage.setItem(`${this.name}:folded`, JSON.stringify(ids));
    } catch {
      // Without storage, the parts are unfolded on the next visit.
    }
  }
}

/** Return saved answers, or null. @param {string} name */
function saved(name) {
  try {
    return checked(JSON.parse(localStorage.getItem(name) ?? "null"));
  } catch {
    return null;
  }
}

/** Save or delete answers. Return false if the browser does not allow it. @param {string} name @param {Front.Answers | null} answers */
function put(name, answers) {
  try {
    if (answers === null) localStorage.removeItem(name);
    else localStorage.setItem(name, JSON.stringify(answers));
    return true;
  } catch {
    return false;
  }
}

/**
 * Return the answers as the fragment of an address.
 *
 * @param {Front.Answers} answers
 */
export function fragment(answers) {
  return NAME + packed(answers);
}

/**
 * Return a value as URL-safe base64.
 *
 * @param {unknown} value
 */
export function packed(value) {
  const bytes = new TextEncoder().encode(JSON.stringify(value));
  const text = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return text.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/**
 * Return the value that `packed` encoded, or null for any other text.
 *
 * @param {string} letters
 * @returns {unknown}
 */
export function unpacked(letters) {
  if (letters.length > LONGEST) return null;
  try {
    const text = atob(letters.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(text, (character) => character.charCodeAt(0));
    return JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
  } catch {
    return null;
  }
}

/**
 * Return the answers in a fragment, or null.
 *
 * @param {string} hash
 */
export function answersIn(hash) {
  return hash.startsWith(NAME) ? checked(unpacked(hash.slice(NAME.length))) : null;
}

/**
 * Return a stored or linked value as answers `{unit, parts: {id: {cells, choice}}}`, or null if it has another shape.
 *
 * @param {any} value
 * @returns {Front.Answers | null}
 */
function checked(value) {
  if (typeof value !== "object" || value === null || typeof value.parts !== "object" || value.parts === null) {
    return null;
  }
  /** @type {(part: any) => boolean} */
  const isPart = (part) =>
    Array.isArray(part?.cells) && part.cells.every((/** @type {unknown} */ cell) => typeof cell === "string");
  const given = Object.entries(value.parts);
  if (!given.every(([, part]) => isPart(part))) return null;
  // Made from entries, so that a part may be named __proto__.
  const parts = Object.fromEntries(
    given.map(([id, { cells, choice }]) => [id, { cells, choice: typeof choice === "string" ? choice : "" }]),
  );
  return { unit: value.unit === "degrees" ? "degrees" : "radians", parts };
}
