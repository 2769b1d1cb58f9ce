// Phrases that several scripts use, among them names for the codes of the service.

import { worded, wordedFor } from "./words.js";
import { number, points } from "../dom.js";

/** @type {Record<Api.Verdict, string>} */
const VERDICTS = {
  correct: worded("correct"),
  partial: worded("partial"),
  incorrect: worded("incorrect"),
  unreadable: worded("unreadable"),
  missing: worded("missing"),
};
/** @type {Record<string, string>} */
const SEVERITIES = {
  error: worded("error"),
  warning: worded("warning"),
  note: worded("note"),
  info: worded("info"),
};

/** @param {Api.Verdict} verdict */
export const verdictName = (verdict) => VERDICTS[verdict];

/** @param {string} severity */
export const severityName = (severity) => SEVERITIES[severity] ?? severity;

/** @param {string} convention */
export const conventionName = (convention) => convention === "modified" ? worded("modified") : worded("standard");

/** Return the maximum number of points of a part in words. @param {number} most */
export const mostInWords = (most) => wordedFor("{number} points", "{number} points", most, { number: number(most) });

/** Return earned points and the maximum number of points in words. @param {number} earned @param {number} most */
export const earnedInWords = (earned, most) => worded("{points} points", { points: points(earned, most) });

/** Return a sentence about the result of a part. @param {string} part @param {Api.PartReport} report */
export const resultInWords = (part, { verdict, points: earned, max_points: most }) =>
  worded("{part}: {verdict}, {points} points.", { part, verdict: verdictName(verdict), points: points(earned, most) });

/** Return a sentence that says that there is nothing to undo or redo. @param {Front.Direction} direction */
export const nothingTo = (direction) => direction === "undo" ? worded("Nothing to undo") : worded("Nothing to redo");

/** Return the name of the field for the option of a part. @param {string} part */
export const optionName = (part) => worded("{part}: option", { part });
