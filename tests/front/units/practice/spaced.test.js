// A situation with a slip comes back until the student was right twice.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";

import { favoured, noteDealt, noteGraded } from "../../../../service/dh_grader/web/static/student/practice/spaced.js";

const BASE = "http://service/";

beforeEach(() => {
  /** @type {Map<string, string>} */
  const kept = new Map();
  Object.defineProperty(globalThis, "localStorage", {
    configurable: true,
    value: {
      getItem: (/** @type {string} */ name) => kept.get(name) ?? null,
      setItem: (/** @type {string} */ name, /** @type {string} */ text) => kept.set(name, text),
    },
  });
});

test("a situation is favoured until two robots with it are right", () => {
  assert.equal(favoured(BASE), null);
  noteGraded(BASE, "one", "sliding");
  assert.equal(favoured(BASE), "sliding");
  for (const id of ["two", "three"]) {
    assert.equal(favoured(BASE), "sliding");
    noteDealt(BASE, id, "sliding");
    noteGraded(BASE, id, null);
    // Checking the same robot again does not count.
    noteGraded(BASE, id, null);
  }
  assert.equal(favoured(BASE), null);
});

test("what must go right more often comes first, and another slip begins again", () => {
  noteGraded(BASE, "one", "turned");
  noteDealt(BASE, "two", "turned");
  noteGraded(BASE, "two", null);
  noteGraded(BASE, "three", "offset");
  assert.equal(favoured(BASE), "offset");
  noteGraded(BASE, "four", "turned");
  noteDealt(BASE, "five", "offset");
  noteGraded(BASE, "five", null);
  assert.equal(favoured(BASE), "turned");
});

test("a robot that was not dealt for a situation pays nothing back", () => {
  noteGraded(BASE, "one", "parallel");
  noteGraded(BASE, "another", null);
  noteDealt(BASE, "two", null);
  noteGraded(BASE, "two", null);
  assert.equal(favoured(BASE), "parallel");
});

test("a spoiled store favours nothing", () => {
  localStorage.setItem(`dh-grader:practice-slips:${BASE}`, '{"left": {"other": 2, "offset": 99}}');
  assert.equal(favoured(BASE), null);
  localStorage.setItem(`dh-grader:practice-slips:${BASE}`, "nonsense");
  assert.equal(favoured(BASE), null);
});
