// The messages of a report as list items.

import { h, visible } from "../shared/dom.js";
import { SIGNS } from "../shared/cell.js";
import { typesetMessage } from "../typeset/names.js";
import { placesInWords } from "./report/places.js";

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
 *   rows?: Api.RowReport[],
 * }} [options] `symbols` are the names that the exercise declares; `rows` those of the part
 */
export function item(feedback, options = {}) {
  const { place = "", verdict = "incorrect", repair = null, action = null, symbols, rows } = options;
  const maths = (/** @type {string} */ each) => typesetMessage(each, symbols);
  const isError = feedback.severity === "error";
  const kind = isError ? verdict : "note";
  const badge = h(
    "span",
    { class: "badge", "data-verdict": kind },
    isError ? h("span", { "aria-hidden": "true" }, SIGNS[verdict]) : feedback.severity,
    isError ? h("span", { class: "aloud" }, verdict) : null,
  );
  const where = [place, feedback.places ? placesInWords(feedback.places, rows) : ""].filter(Boolean).join(": ");
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
  const example = feedback.values ? counterexample(feedback.values) : "";
  if (example) text.append(" ", h("span", { class: "quiet" }, ...maths(example)));
  if (feedback.suggestion && repair) text.append(" ", repair(feedback.suggestion));
  if (action) text.append(" ", action);
  return h("li", {}, badge, text);
}

/** @param {Record<string, string | number>} values */
function counterexample(values) {
  const given = Object.entries(values).filter(([name]) => name !== YOURS && name !== EXPECTED);
  // "with l2 = 0.4, yours gives 0.4" tells nothing.
  if (!(EXPECTED in values) && given.length === 1 && given[0][1] === values[YOURS]) return "";
  const told = [];
  if (given.length) told.push(`with ${given.map(([name, value]) => `${name} = ${value}`).join(", ")}`);
  if (YOURS in values) told.push(`yours gives ${values[YOURS]}`);
  if (EXPECTED in values) told.push(`not ${values[EXPECTED]}`);
  return `(${told.join(", ")})`;
}
