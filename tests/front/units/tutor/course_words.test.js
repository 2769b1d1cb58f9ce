// The sentences of the forms of a course, before and after a request.

import assert from "node:assert/strict";
import test from "node:test";

import { doneBy, faultsIn } from "../../../../service/dh_grader/web/static/tutor/courses/course_words.js";

const NOW = Date.parse("2026-10-10T12:00:00Z");
const [PAST, LATER] = ["2026-10-10T13:59:59+02:00", "2026-10-10T14:00:01+02:00"];

/** @param {string} [due] @param {string} [closes] @param {string[]} [others] */
const saved = (due, closes, others = []) =>
  doneBy([{ title: "HW", late_worth: 0.5, due, closes, extensions: others }], NOW);

test("a form without an exercise or with a wrong id is not sent", () => {
  const id = "The id has small letters, digits and hyphens, such as homework-1.";
  const exercises = "Choose at least one exercise.";
  assert.equal(faultsIn({ id: "HW 9", exercises: [] }), `${id} ${exercises}`);
  for (const wrong of ["a_b", "-a", "a-", "é", "A"]) assert.equal(faultsIn({ id: wrong }), id);
  assert.equal(faultsIn({ id: "homework-1", exercises: [{}] }), "");
  assert.equal(faultsIn({ id: null, title: "" }), "");
});

test("the learners of all pieces of a list are counted", () => {
  assert.equal(doneBy([{ listed: 1, added: 1 }]), "1 learner, 1 of them new.");
  assert.equal(doneBy([{ listed: 100, added: 100 }, { listed: 50, added: 49 }]), "150 learners, 149 of them new.");
});

test("a saved assignment says what its dates mean", () => {
  const empty = "No late attempts are accepted, because Closes is empty.";
  assert.equal(saved(), "Saved: HW.");
  assert.equal(saved(LATER), `Saved: HW. ${empty}`);
  assert.equal(saved(LATER, LATER), "Saved: HW.");
  assert.equal(saved(PAST), `Saved: HW. ${empty} Attention: these dates have passed. Nobody can hand in.`);
  assert.equal(saved(PAST, PAST), "Saved: HW. Attention: these dates have passed. Nobody can hand in.");
  assert.equal(saved(PAST, LATER), "Saved: HW. Attention: Due has passed. All attempts are late.");
  assert.equal(saved(PAST, PAST, ["someone's"]), "Saved: HW.");
  assert.equal(doneBy([{ title: "A course" }], NOW), "");
});
