// The sentences of the forms of a course, before and after a request.

import { worded, wordedFor } from "../../shared/words/words.js";

const ID = /^[a-z0-9]+(-[a-z0-9]+)*$/u;

/**
 * Return sentences about the mistakes in a form, or "" if the form can be sent.
 *
 * @param {Record<string, unknown>} body
 */
export function faultsIn({ id, exercises }) {
  const faults = [];
  if (typeof id === "string" && !ID.test(id)) {
    faults.push(worded("The id has small letters, digits and hyphens, such as homework-1."));
  }
  if (Array.isArray(exercises) && exercises.length === 0) faults.push(worded("Choose at least one exercise."));
  return faults.join(" ");
}

/**
 * Return a sentence about what a request has done, or "" if the page shows it anyway. `answers` has one response for
 * each piece of the request.
 *
 * @param {any[]} answers
 * @param {number} [now]
 */
export function doneBy(answers, now = Date.now()) {
  const [first] = answers;
  if (first.listed !== undefined) {
    const listed = answers.reduce((sum, each) => sum + each.listed, 0);
    const added = answers.reduce((sum, each) => sum + each.added, 0);
    return wordedFor("{count} learner, {added} of them new.", "{count} learners, {added} of them new.", listed, {
      added,
    });
  }
  return first.late_worth === undefined ? "" : savedAssignment(first, now);
}

/** @param {Api.CourseAssignment} assignment @param {number} now */
function savedAssignment({ title, due, closes, extensions }, now) {
  const told = [worded("Saved: {title}.", { title })];
  // If some learners have other dates, the warnings may not apply to them.
  if (extensions.length) return told[0];
  if (due && !closes) told.push(worded("No late attempts are accepted, because Closes is empty."));
  const end = closes ?? due;
  if (end && Date.parse(end) < now) told.push(worded("Attention: these dates have passed. Nobody can hand in."));
  else if (due && Date.parse(due) < now) told.push(worded("Attention: Due has passed. All attempts are late."));
  return told.join(" ");
}
