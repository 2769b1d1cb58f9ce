// List items that say how many points a part has lost, and at which places.

import { h, number } from "../../shared/dom.js";
import { typesetMessage } from "../../typeset/names.js";
import { matrixOf } from "./places.js";
import { severityName } from "../../shared/words/phrases.js";

// The codes of losses about which the report already has a message.
const NOTHING_READ = new Set(["no_answer", "not_read"]);

/**
 * Return the items below the messages of a part: its lost points with their places, and why a row of zeros earned
 * little. Reports of older versions have no such items.
 *
 * @param {Api.PartReport} report
 * @param {Set<string>} [symbols] that the exercise declares
 */
export function lostItems({ lost = [], little_worth: little }, symbols) {
  return [
    ...lostLines(lost).map(([badge, text]) => note(badge, text, symbols)),
    ...(little ? [note(severityName("info"), little.message, symbols)] : []),
  ];
}

/**
 * Return the lines about lost points: each has a sum of points and places. A loss for the whole part has its own line.
 *
 * @param {Api.LostPoints[]} lost
 * @returns {[string, string][]}
 */
export function lostLines(lost) {
  const told = lost.filter(({ code }) => !NOTHING_READ.has(code));
  const [whole, others] = [true, false].map((isWhole) => told.filter(({ code }) => (code === "whole") === isWhole));
  return [whole, others].filter(({ length }) => length).map((losses) => {
    const entries = byMatrix(losses);
    const places = entries.length === 1 ? entries[0].message : entries.map(lostAt).join("; ");
    return [`−${number(sum(losses))}`, places];
  });
}

/**
 * Return the losses; for each matrix, one entry replaces the entries of the matrix's rows.
 *
 * @param {Api.LostPoints[]} lost
 */
function byMatrix(lost) {
  /** @type {Map<string, Api.LostPoints>} */
  const found = new Map();
  lost.forEach((each, i) => {
    const matrix = each.row ? matrixOf(each.row) : null;
    const key = matrix ?? `${i}`;
    const before = found.get(key)?.points ?? 0;
    found.set(key, matrix ? { ...each, points: before + each.points, message: matrix } : each);
  });
  return [...found.values()];
}

/** @param {Api.LostPoints} lost */
function lostAt({ points, message }) {
  return `−${number(points)}: ${message}`;
}

/** @param {Api.LostPoints[]} lost */
function sum(lost) {
  return lost.reduce((total, { points }) => total + points, 0);
}

/** @param {string} badge @param {string} text @param {Set<string>} [symbols] */
function note(badge, text, symbols) {
  return h(
    "li",
    { class: "lost" },
    h("span", { class: "badge", "data-verdict": "note" }, badge),
    h("p", {}, ...typesetMessage(text, symbols)),
  );
}
