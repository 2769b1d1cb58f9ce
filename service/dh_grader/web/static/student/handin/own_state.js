// What a learner may do now at one exercise of an assignment, and the sentences about it.

import { number } from "../../shared/dom.js";
import { momentIn } from "./dates.js";
import { worded, wordedFor } from "../../shared/words/words.js";

/** @type {Record<Api.AssignmentState, string>} */
export const STATES = {
  not_open: worded("not open yet"),
  open: worded("open"),
  late: worded("late"),
  closed: worded("closed"),
};

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
  return exercise.attempts_left === 0 ? worded("You have no attempts left at this exercise.") : "";
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
    ? worded("Late attempts until {moment} earn {share} of their points.", {
      moment: at(closes),
      share: percent(worth),
    })
    : "";
  switch (state) {
    case "not_open":
      return [worded("Opens {moment}.", { moment: at(opens) }), due ? worded("Due {moment}.", { moment: at(due) }) : ""]
        .filter(Boolean).join(" ");
    case "closed":
      return worded("Closed since {moment}.", { moment: at(closes ?? due) });
    case "late":
      return [worded("It was due {moment}.", { moment: at(due) }), late].filter(Boolean).join(" ");
  }
  return due ? [worded("Due {moment}.", { moment: at(due) }), late].filter(Boolean).join(" ") : worded("No due date.");
}

/**
 * Return in words how many attempts are left.
 *
 * @param {Pick<Api.OwnAssignment, "limit">} assignment
 * @param {Pick<Api.OwnExercise, "attempts_left">} exercise
 */
export function attemptsInWords({ limit }, { attempts_left: left }) {
  if (left === undefined || limit === undefined) return worded("Attempts are not limited");
  return left ? worded("{left} of {limit} attempts left", { left, limit }) : worded("No attempts left");
}

/**
 * Return in words the points that count, and the points of the best attempt if these are more.
 *
 * @param {Pick<Api.OwnExercise, "points" | "earned" | "best">} exercise
 */
export function pointsInWords({ points: most, earned, best }) {
  if (earned === undefined) return worded("{points} points, nothing handed in", { points: number(most) });
  const counted = { points: number(earned), most: number(most) };
  return best !== undefined && best > earned + 1e-9
    ? worded("{points} of {most} points count; best attempt: {best}", { ...counted, best: number(best) })
    : worded("{points} of {most} points count", counted);
}

/**
 * Return in words how many hints the learner has taken, and how many points they cost the next attempt.
 *
 * @param {Pick<Api.OwnExercise, "points" | "hints">} exercise
 */
export function hintsInWords({ points, hints = [] }) {
  if (!hints.length) return "";
  const price = hints.reduce((sum, each) => sum + each.price, 0);
  if (!price) return wordedFor("1 hint taken", "{count} hints taken", hints.length);
  return wordedFor(
    "1 hint taken: −{points} in the next attempt",
    "{count} hints taken: −{points} in the next attempt",
    hints.length,
    { points: number(Math.min(price, 1) * points) },
  );
}

/**
 * Return the name of an attempt: its number in the assignment. (The service's numbers also count attempts in other
 * assignments.)
 *
 * @param {Pick<Api.OwnExercise, "attempts">} exercise
 * @param {string} id
 */
export function attemptName({ attempts }, id) {
  const counted = attempts.filter(({ ordinal }) => ordinal !== undefined);
  const place = counted.findIndex((each) => each.id === id);
  return place < 0 ? worded("Not counted: nothing could be read") : worded("Attempt {number}", { number: place + 1 });
}

/**
 * Return in words the points of an attempt, scaled to the points of the exercise in the assignment.
 *
 * @param {Pick<Api.Attempt, "points" | "max_points" | "is_late" | "hint_points">} attempt
 * @param {Pick<Api.OwnExercise, "points">} exercise
 */
export function attemptPoints(
  { points, max_points: most, is_late: isLate, hint_points: hints = 0 },
  { points: worth },
) {
  const scale = most ? worth / most : 0;
  const values = { points: number(points * scale), most: number(worth), lost: number(hints * scale) };
  if (hints) {
    return isLate
      ? worded("{points} of {most} points, −{lost} for hints, late", values)
      : worded("{points} of {most} points, −{lost} for hints", values);
  }
  return isLate ? worded("{points} of {most} points, late", values) : worded("{points} of {most} points", values);
}

/** @param {number} share */
const percent = (share) => `${number(100 * share)} %`;

/**
 * Return the sentence about a refused hand-in. If an earlier response was lost, the hand-in may have been recorded.
 *
 * @param {string} reason
 * @param {boolean} mayBeRecorded
 */
export function refusalInWords(reason, mayBeRecorded) {
  return mayBeRecorded ? worded("Not confirmed: {reason}", { reason }) : worded("Not handed in: {reason}", { reason });
}
