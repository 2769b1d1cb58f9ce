// The list of a learner's courses and assignments.

import { h, visible } from "../shared/dom.js";
import { attemptsInWords, datesInWords, pointsInWords, STATES } from "../student/handin/own_state.js";
import { typeset } from "../typeset/names.js";
import { fragmentOf } from "./link_key.js";
import { worded, wordedFor } from "../shared/words/words.js";

export const MISSING = worded(
  "This exercise is not there at the moment. It is noted in the log of the service. What you have handed in is not lost.",
);

/** @param {Api.OwnCourses} view */
export function overview({ courses }) {
  if (!courses.length) {
    return [h("h1", {}, worded("My assignments")), h("p", {}, worded("You are in no course at the moment."))];
  }
  return [h("h1", {}, worded("My assignments")), ...courses.map(courseSection)];
}

/** @param {Api.OwnCourse} course */
function courseSection(course) {
  const { title, zone, name, assignments } = course;
  return h(
    "section",
    { class: "course" },
    h("h2", {}, visible(title)),
    h("p", { class: "quiet" }, worded("{course} · times of {zone}", { course: visible(name), zone: visible(zone) })),
    assignments.length ? null : h("p", {}, worded("There are no assignments yet.")),
    ...assignments.map((each) => assignmentCard(course, each)),
  );
}

/** @param {Api.OwnCourse} course @param {Api.OwnAssignment} assignment */
function assignmentCard(course, assignment) {
  const { id, title, state, is_extended: isExtended, exercises } = assignment;
  return h(
    "section",
    { class: "assignment" },
    h(
      "header",
      {},
      h("h3", {}, visible(title)),
      h("span", { class: "badge", "data-state": state }, STATES[state]),
      isExtended ? h("span", { class: "badge" }, worded("extended for you")) : null,
    ),
    h("p", {}, datesInWords(course, assignment)),
    h(
      "ul",
      {},
      ...exercises.map((each) =>
        h(
          "li",
          {},
          each.is_missing ? h("span", {}, visible(each.title)) : h(
            "a",
            { href: fragmentOf({ path: `${course.id}/${id}`, exercise: each.exercise }) },
            ...typeset(visible(each.title)),
          ),
          h("span", {}, pointsInWords(each)),
          h("span", { class: "quiet" }, [attemptsInWords(assignment, each), ...handedIn(each)].join(" · ")),
          each.is_missing ? h("p", { class: "quiet" }, MISSING) : null,
        )
      ),
    ),
  );
}

/** @param {Api.OwnExercise} exercise */
function handedIn({ attempts, shows_solution: hasSolution }) {
  const done = attempts.length ? [wordedFor("1 handed in", "{count} handed in", attempts.length)] : [];
  return hasSolution ? [...done, worded("with solution")] : done;
}
