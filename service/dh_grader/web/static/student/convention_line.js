// The sentence at the top of the form if the last exercise had another convention. The tab remembers this convention.

import { h } from "../shared/dom.js";
import { worded } from "../shared/words/words.js";

const NAME = "dh-grader:convention";

/** The last exercise that has only one convention, its convention, and the convention before this exercise. */
/** @typedef {{ exercise: string, convention: string, before: string | null }} Last */

/**
 * Return what to remember after an exercise is opened. A reload does not change what is remembered.
 *
 * @param {Last | null} last
 * @param {string} exercise
 * @param {string} convention
 * @returns {Last}
 */
export function opened(last, exercise, convention) {
  const before = last?.exercise === exercise && last.convention === convention ? last.before : last?.convention;
  return { exercise, convention, before: before ?? null };
}

/**
 * Return the line that says that the convention has changed, or null. Exercises of both conventions, or of none, change
 * nothing.
 *
 * @param {Pick<Api.Exercise, "id" | "conventions">} exercise
 */
export function conventionLine({ id, conventions }) {
  const [convention, other] = conventions ?? [];
  if (!convention || other) return null;
  const { before } = noted(id, convention);
  if (!before || before === convention) return null;
  return h(
    "p",
    { class: "card notice convention-line" },
    convention === "modified"
      ? worded("This exercise uses the modified convention. The exercise before used the standard convention.")
      : worded("This exercise uses the standard convention. The exercise before used the modified convention."),
  );
}

/** @param {string} id @param {string} convention @returns {Last} */
function noted(id, convention) {
  try {
    const next = opened(JSON.parse(sessionStorage.getItem(NAME) ?? "null"), id, convention);
    sessionStorage.setItem(NAME, JSON.stringify(next));
    return next;
  } catch {
    // Without storage, nothing is known of the last exercise.
    return { exercise: id, convention, before: null };
  }
}
