// An exercise of an assignment: the form, the learner's attempts, a report, and the solution.

import { h, visible } from "../shared/dom.js";
import { nullIfRefused } from "../shared/service.js";
import { momentIn } from "../student/handin/dates.js";
import { attemptName, attemptPoints } from "../student/handin/own_state.js";
import { besides } from "../student/hints/solution.js";
import { RecordedReport } from "../tutor/records/recorded_report.js";
import { fragmentOf } from "./link_key.js";
import { worded } from "../shared/words/words.js";

const HINTS = new URL("../student/hints/hints.css", import.meta.url).href;

export const back = () => h("p", { class: "ways-on" }, h("a", { href: "#" }, worded("← All assignments")));

/**
 * Return the form of an exercise, and an empty section for the learner's attempts, which `handedIn` lists.
 *
 * @param {Front.Assigned} place
 * @param {string} key
 */
export function form({ path, exercise }, key) {
  const element = document.createElement("dh-exercise");
  for (const [name, value] of Object.entries({ exercise, assignment: path, token: key, submit: "", linked: "" })) {
    element.setAttribute(name, value);
  }
  const done = h("section", { class: "handed-in", "aria-label": worded("Handed in") });
  return { element, done };
}

/**
 * Return the list of the learner's attempts at an exercise, and a button that shows the model solution.
 *
 * @param {Front.Own} own
 * @param {Front.Assigned} place
 * @param {() => void} showSolution
 */
export function handedIn({ course, exercise }, place, showSolution) {
  const rows = exercise.attempts.toReversed().map((each) =>
    h(
      "li",
      {},
      h("a", { href: fragmentOf({ ...place, attempt: each.id }) }, attemptName(exercise, each.id)),
      h("span", {}, momentIn(each.at, course.zone)),
      h("span", {}, attemptPoints(each, exercise)),
      each.counts ? h("span", { class: "badge" }, worded("counts")) : null,
    )
  );
  return [
    h("h2", {}, worded("What you handed in")),
    rows.length ? h("ul", {}, ...rows) : h("p", { class: "quiet" }, worded("Nothing yet.")),
    exercise.shows_solution
      ? h("button", { type: "button", class: "quiet-button", onclick: showSolution }, worded("Show the solution"))
      : null,
  ];
}

/**
 * Return the report on an attempt.
 *
 * @param {Front.Service} service
 * @param {Front.Assigned} place
 * @param {Front.Own} own
 */
export async function report(service, place, { course, exercise: own }) {
  const assigned = service.within(place.path);
  const [found, exercise] = await Promise.all([
    service.attempt(place.attempt ?? ""),
    assigned.exercise(place.exercise).catch(nullIfRefused),
  ]);
  const attempt = own.attempts.find(({ id }) => id === found.attempt.id);
  const drawn = new RecordedReport(exercise, found.submission, assigned);
  drawn.show(found.report);
  const facts = attempt
    ? [attemptName(own, attempt.id), momentIn(attempt.at, course.zone), attemptPoints(attempt, own)].join(" · ")
    : momentIn(found.attempt.at, course.zone);
  return [
    h("h1", {}, visible(own.title)),
    h("p", {}, facts),
    h(
      "p",
      {},
      h("a", { href: fragmentOf({ path: place.path, exercise: place.exercise }) }, worded("Back to the exercise")),
    ),
    drawn.element,
  ];
}

/**
 * Return the model solution beside the answers of the attempt that counts.
 *
 * @param {Front.Service} service
 * @param {Front.Assigned} place
 * @param {Front.Own} own
 */
export async function solution(service, { path, exercise }, { exercise: { attempts } }) {
  const counting = attempts.find(({ counts }) => counts);
  const [{ parts }, shown, found] = await Promise.all([
    service.assignedSolution(path, exercise),
    service.within(path).exercise(exercise).catch(nullIfRefused),
    counting ? service.attempt(counting.id) : null,
  ]);
  const answers = /** @type {Record<string, unknown>} */ (found?.submission.answers ?? {});
  const style = h("link", { rel: "stylesheet", href: HINTS });
  return [style, h("h2", { tabindex: -1 }, worded("Solution")), ...besides(shown, parts, answers)];
}
