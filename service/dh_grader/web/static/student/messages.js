// The messages of a report as list items.

import { h, visible } from "../shared/dom.js";
import { SIGNS } from "../shared/cell.js";
import { typesetMessage } from "../typeset/names.js";
import { placesInWords } from "./report/places.js";
import { severityName, verdictName } from "../shared/words/phrases.js";
import { placed, worded } from "../shared/words/words.js";

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
 * }} [options] `symbols` are the names that the exercise declares; `rows` the rows of the part
 */
export function item(feedback, options = {}) {
  const { place = "", verdict = "incorrect", repair = null, action = null, symbols, rows } = options;
  const maths = (/** @type {string} */ each) => typesetMessage(each, symbols);
  const isError = feedback.severity === "error";
  const kind = isError ? verdict : "note";
  const badge = h(
    "span",
    { class: "badge", "data-verdict": kind },
    isError ? h("span", { "aria-hidden": "true" }, SIGNS[verdict]) : severityName(feedback.severity),
    isError ? h("span", { class: "aloud" }, verdictName(verdict)) : null,
  );
  const where = [place, feedback.places ? placesInWords(feedback.places, rows) : ""].filter(Boolean).join(": ");
  const text = h("p", {}, where ? h("strong", {}, ...maths(where), ": ") : null, ...maths(feedback.message));
  const correction = feedback.correction;
  if (correction) {
    text.append(
      " ",
      ...(correction.latex === undefined
        ? maths(correction.text)
        : placed(worded("It should be {formula}."), { formula: h("code", {}, visible(correction.text)) })),
    );
  }
  const example = feedback.values ? counterexample(feedback.values) : "";
  if (example) text.append(" ", h("span", { class: "quiet" }, ...maths(example)));
  if (feedback.suggestion && repair) text.append(" ", repair(feedback.suggestion));
  if (action) text.append(" ", action);
  return h("li", {}, badge, text);
}

/**
 * Say that a message is about the text before the student's change, and remove the proposals of the message.
 *
 * @param {HTMLElement} told a list item
 */
export function outdate(told) {
  const badge = told.querySelector(".badge");
  told.classList.add("past");
  badge?.removeAttribute("data-verdict");
  badge?.replaceChildren(worded("before your change"));
  for (const button of told.querySelectorAll("p > button")) button.remove();
}

/** @param {Record<string, string | number>} values */
function counterexample(values) {
  const given = Object.entries(values).filter(([name]) => name !== YOURS && name !== EXPECTED);
  // An example such as "with l2 = 0.4, yours gives 0.4" is no help.
  if (!(EXPECTED in values) && given.length === 1 && given[0][1] === values[YOURS]) return "";
  const { [YOURS]: yours, [EXPECTED]: expected } = values;
  return exampleInWords(given.map(([name, value]) => `${name} = ${value}`).join(", "), yours, expected);
}

/** @param {string} given @param {string | number | undefined} yours @param {string | number | undefined} expected */
function exampleInWords(given, yours, expected) {
  if (yours === undefined) {
    if (expected === undefined) return worded("(with {given})", { given });
    return given
      ? worded("(with {given}, not {expected})", { given, expected })
      : worded("(not {expected})", { expected });
  }
  if (expected === undefined) {
    return given
      ? worded("(with {given}, yours gives {yours})", { given, yours })
      : worded("(yours gives {yours})", { yours });
  }
  return given
    ? worded("(with {given}, yours gives {yours}, not {expected})", { given, yours, expected })
    : worded("(yours gives {yours}, not {expected})", { yours, expected });
}

/** Return a note if a part was graded with the student's own earlier answer. @param {Api.PartReport} report */
export const followedItems = ({ follow_through: isFollowed }) =>
  isFollowed ? [item({ severity: "note", message: worded("Counted with your own earlier answer.") })] : [];

/**
 * Return the messages on a part, and on rows that the form does not show; each has its place.
 *
 * @param {Api.Feedback[]} feedback
 * @param {Iterable<Api.RowReport>} rows
 * @returns {[Api.Feedback, Front.Topic | undefined][]}
 */
export function messagesOf(feedback, rows) {
  return [
    ...feedback.map((each) => /** @type {[Api.Feedback, Front.Topic | undefined]} */ ([each, each.places?.[0]])),
    ...[...rows].flatMap(({ label: row, feedback, cells }) => [
      ...feedback.map((each) => /** @type {[Api.Feedback, Front.Topic]} */ ([each, { row }])),
      ...cells.flatMap(({ label: cell, feedback }) =>
        feedback.map((each) => /** @type {[Api.Feedback, Front.Topic]} */ ([each, { row, cell }]))
      ),
    ]),
  ];
}
