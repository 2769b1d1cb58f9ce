// Saves answers in the browser, and packs them into links. A browser without storage is no error.

import { worded } from "./words/words.js";

const PREFIX = "dh-grader";
// The fragment of an address is never sent to a server.
const NAME = "#answers=";
const LONGEST = 60_000;

/** The saved answers to one exercise of one service. */
export class Store {
  // The sentence for the student if the answers cannot be saved.
  unsaved = worded("This browser cannot save your answers: a reload loses them");

  /** @param {string} base @param {string} exercise */
  constructor(base, exercise) {
    this.name = `${PREFIX}:${base}:${exercise}`;
  }

  load() {
    try {
      return checked(JSON.parse(localStorage.getItem(this.name) ?? "null"));
    } catch {
      return null;
    }
  }

  /**
   * Save the answers; null deletes them. Return false if the browser does not allow it.
   *
   * @param {Front.Answers | null} answers
   */
  save(answers) {
    try {
      if (answers === null) localStorage.removeItem(this.name);
      else localStorage.setItem(this.name, JSON.stringify(answers));
      return true;
    } catch {
      return false;
    }
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
