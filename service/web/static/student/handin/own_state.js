// What a learner may do now at one exercise of an assignment, and the sentences about it.

import { number } from "../../shared/dom.js";
import { momentIn } from "./dates.js";

/** @type {Record<Api.AssignmentState, string>} */
export const STATES = { not_open: "not open yet", open: "open", late: "late", closed: "closed" };

/**
 * Return the state of an exercise, or null if the learner has no such assignment or exercise.
 *
 * @param {Api.OwnCourses} view
 * @param {string} path "course/assignment"
 * @param {string} id the exercise
 * @returns {Front.Own | null}
 */
export function ownState({ learner, courses }, path, id) {
  for (const course of courses) {
    const assignment = course.assignments.find((each) => `${course.id}/${each.id}` === path);
    const exercise = assignment?.exercises.find((each) => each.exercise === id);
    if (assignment && exercise) return { learner, course, assignment, exercise };
  }
  return null;
}

/**
 * Return why the learner cannot hand in now, or an empty text.
 *
 * @param {Pick<Front.Own, "course" | "assignment" | "exercise">} own
 */
export function whyClosed({ course, assignment, exercise }) {
  if (assignment.state === "not_open" || assignment.state === "closed") return datesInWords(course, assignment);
  return exercise.attempts_left === 0 ? "You have no attempts left at this exercise." : "";
}

/**
 * Return the dates of an assignment in one or two sentences; `own` is the learner's time zone.
 *
 * @param {Pick<Api.OwnCourse, "zone">} course
 * @param {Api.OwnAssignment} assignment
 * @param {string} [own]
 */
export function datesInWords({ zone }, { state, opens, due, closes, late_worth: worth }, own) {
  const at = (/** @type {string | undefined} */ moment) => moment ? momentIn(moment, zone, own) : "";
  const late = closes && closes !== due
    ? `Late attempts until ${at(closes)} earn ${percent(worth)} of their points.`
    : "";
  switch (state) {
    case "not_open":
      return [`Opens ${at(opens)}.`, due ? `Due ${at(due)}.` : ""].filter(Boolean).join(" ");
    case "closed":
      return `Closed since ${at(closes ?? due)}.`;
    case "late":
      return `It was due ${at(due)}. ${late}`;
  }
  return due ? [`Due ${at(due)}.`, late].filter(Boolean).join(" ") : "No due date.";
}

/**
 * Return how many attempts are left in words.
 *
 * @param {Pick<Api.OwnAssignment, "limit">} assignment
 * @param {Pick<Api.OwnExercise, "attempts_left">} exercise
 */
export function attemptsInWords({ limit }, { attempts_left: left }) {
  if (left === undefined || limit === undefined) return "Attempts are not limited";
  return left ? `${left} of ${limit} attempts left` : "No attempts left";
}

/**
 * Return the points that count in words, and the best ones if they are more.
 *
 * @param {Pick<Api.OwnExercise, "points" | "earned" | "best">} exercise
 */
export function pointsInWords({ points: most, earned, best }) {
  if (earned === undefined) return `${number(most)} points, nothing handed in`;
  const counted = `${number(earned)} of ${number(most)} points count`;
  return best !== undefined && best > earned + 1e-9 ? `${counted}; best attempt: ${number(best)}` : counted;
}

/**
 * Return how many hints the learner has taken in words, and what they cost the next attempt.
 *
 * @param {Pick<Api.OwnExercise, "points" | "hints">} exercise
 */
export function hintsInWords({ points, hints = [] }) {
  if (!hints.length) return "";
  const price = hints.reduce((sum, each) => sum + each.price, 0);
  const cost = price ? `: −${number(Math.min(price, 1) * points)} in the next attempt` : "";
  return `${hints.length} ${hints.length === 1 ? "hint" : "hints"} taken${cost}`;
}

/**
 * Return the name of an attempt: its number in the assignment. The service numbers the attempts at the exercise, also in
 * other assignments.
 *
 * @param {Pick<Api.OwnExercise, "attempts">} exercise
 * @param {string} id
 */
export function attemptName({ attempts }, id) {
  const counted = attempts.filter(({ ordinal }) => ordinal !== undefined);
  const place = counted.findIndex((each) => each.id === id);
  return place < 0 ? "Not counted: nothing could be read" : `Attempt ${place + 1}`;
}

/**
 * Return the points of an attempt in words, of those that the exercise has in the assignment.
 *
 * @param {Pick<Api.Attempt, "points" | "max_points" | "is_late" | "hint_points">} attempt
 * @param {Pick<Api.OwnExercise, "points">} exercise
 */
export function attemptPoints(
  { points, max_points: most, is_late: isLate, hint_points: hints = 0 },
  { points: worth },
) {
  const scale = most ? worth / most : 0;
  const lost = hints ? `, −${number(hints * scale)} for hints` : "";
  return `${number(points * scale)} of ${number(worth)} points${lost}${isLate ? ", late" : ""}`;
}

/** @param {number} share */
const percent = (share) => `${number(100 * share)} %`;

/**
 * Return what is told of a hand-in that the service refuses. If an answer was lost before, it may have been recorded.
 *
 * @param {string} reason
 * @param {boolean} mayBeRecorded
 */
export function refusalInWords(reason, mayBeRecorded) {
  return `${mayBeRecorded ? "Not confirmed" : "Not handed in"}: ${reason}`;
}
