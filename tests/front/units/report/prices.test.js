// The prices of hints in words, by the step and by what the learner has taken.

import assert from "node:assert/strict";
import { test } from "node:test";

import { attemptPoints, hintsInWords } from "../../../../service/dh_grader/web/static/student/handin/own_state.js";
import { priceInWords, pricesOf, tryFirst } from "../../../../service/dh_grader/web/static/student/hints/prices.js";

const TOPIC = { part: "table", code: "sign", row: "2", cell: "alpha" };
const taken = [{ attempt: "x", at: "", price: 0.05, step: 2, ...TOPIC }];
const offer = { attempt: "x", prices: [0, 0.05, 0.1], taken: [], points: 10 };

test("a step names its price in the points of the assignment", () => {
  assert.equal(priceInWords(offer, TOPIC, 1), "");
  assert.equal(priceInWords(offer, TOPIC, 3), "costs 1 of 10 points of each later attempt");
});

test("a step that was taken costs nothing again, at its own place only", () => {
  assert.equal(priceInWords({ ...offer, taken }, TOPIC, 2), "you have taken it");
  assert.match(priceInWords({ ...offer, taken }, { ...TOPIC, row: "3" }, 2), /^costs 0.5 /);
});

test("hints have prices only at the report of an attempt", () => {
  const exercise = { hint_prices: [0, 0, 0], points: 10 };
  const handIn = /** @type {any} */ ({ own: { exercise } });
  assert.deepEqual(pricesOf(handIn, "x"), { attempt: "x", prices: [0, 0, 0], taken: [], points: 10 });
  assert.equal(pricesOf(handIn, ""), null);
  assert.equal(pricesOf(null, "x"), null);
  assert.equal(pricesOf(/** @type {any} */ ({ own: { exercise: { points: 10 } } }), "x"), null);
});

test("the state says what the hints cost in the next attempt, and an attempt what they have cost", () => {
  assert.equal(hintsInWords({ points: 10, hints: [] }), "");
  assert.equal(hintsInWords({ points: 10, hints: taken }), "1 hint taken: −0.5 in the next attempt");
  const attempt = { points: 12, max_points: 24, hint_points: 2.4, is_late: true };
  assert.equal(attemptPoints(attempt, { points: 10 }), "5 of 10 points, −1 for hints, late");
  assert.match(tryFirst(offer), /hand it in again/);
});
