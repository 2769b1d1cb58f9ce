// The messages of a report as list items.

import { h, visible } from "../shared/dom.js";
import { SIGNS } from "../shared/cell.js";
import { typesetMessage } from "../typeset/names.js";

/** @type {Record<string, string>} */
const NAMES = { alpha: "α", theta: "θ" };
const YOURS = "yours";
const EXPECTED = "expected";

/**
 * Return a list item with a message, its places, its correction or repair, and its counterexample.
 *
 * @param {Omit<Api.Feedback, "code" | "severity"> & { severity: string }} feedback
 * @param {{
 *   place?: string,
 *   verdict?: Api.Verdict,
 *   repair?: ((suggestion: string) => HTMLElement) | null,
 *   action?: HTMLElement | null,
 *   symbols?: Set<string>,
 * }} [options] `symbols` are the names that the exercise declares
 */
export function item(feedback, { place = "", verdict = "incorrect", repair = null, action = null, symbols } = {}) {
  const maths = (/** @type {string} */ each) => typesetMessage(each, symbols);
  const isError = feedback.severity === "error";
  const kind = isError ? verdict : "note";
  const badge = h(
    "span",
    { class: "badge", "data-verdict": kind },
    isError ? h("span", { "aria-hidden": "true" }, SIGNS[verdict]) : feedback.severity,
    isError ? h("span", { class: "aloud" }, verdict) : null,
  );
  const where = [place, feedback.places ? placesInWords(feedback.places) : ""].filter(Boolean).join(": ");
  const text = h("p", {}, where ? h("strong", {}, ...maths(where), ": ") : null, ...maths(feedback.message));
  const correction = feedback.correction;
  if (correction) {
    text.append(
      " ",
      ...(correction.latex === undefined
        ? maths(correction.text)
        : ["It should be ", h("code", {}, visible(correction.text)), "."]),
    );
  }
  if (feedback.values) text.append(" ", h("span", { class: "quiet" }, ...maths(counterexample(feedback.values))));
  if (feedback.suggestion && repair) text.append(" ", repair(feedback.suggestion));
  if (action) text.append(" ", action);
  return h("li", {}, badge, text);
}

/**
 * Return places in words, such as "row 1 d, θ; row 2".
 *
 * @param {Api.Place[]} places
 */
function placesInWords(places) {
  const rows = new Map();
  for (const { row, cell } of places) {
    if (!rows.has(row)) rows.set(row, []);
    if (cell !== undefined) rows.get(row).push(cellName(cell));
  }
  return [...rows].map(([row, cells]) => `row ${row}${cells.length ? ` ${cells.join(", ")}` : ""}`).join("; ");
}

/**
 * Return the name of a cell with this label in a report.
 *
 * @param {string} label
 */
export function cellName(label) {
  return NAMES[label] ?? (/^\d+$/.test(label) ? `column ${label}` : label);
}

/** @param {Record<string, string | number>} values */
function counterexample(values) {
  const given = Object.entries(values).filter(([name]) => name !== YOURS && name !== EXPECTED);
  const told = [];
  if (given.length) told.push(`with ${given.map(([name, value]) => `${name} = ${value}`).join(", ")}`);
  if (YOURS in values) told.push(`yours gives ${values[YOURS]}`);
  if (EXPECTED in values) told.push(`not ${values[EXPECTED]}`);
  return `(${told.join(", ")})`;
}
