import assert from "node:assert/strict";
import { test } from "node:test";
import { offersOf } from "../../../../service/dh_grader/web/static/robot/placing/offers.js";

// Joint 1 is along z, joint 2 is along y at x = a. The tool is at x = a + b, in a direction that depends on b.
const linesAt = (a, b) => [
  [[0, 0, 0.11], [0, 0, 1]],
  [[a, 0, 0], [0, 1, 0]],
  [[a + b, 0, 0], [0, Math.sin(b), Math.cos(b)]],
];
const found = offersOf(linesAt(0.5, 0.5), linesAt(0.5423, 0.5455), ["a", "b"], [0.5423, 0.5455], 2);
const texts = (places) => places.map((place) => place.texts.join(", ")).sort();

test("an origin is offered if it is a sum of symbols", () => {
  // The middle of joint 1 at 0.11 is only a place in the drawing.
  assert.deepEqual(texts(found.places), ["0, 0, 0", "a + b, 0, 0", "a, 0, 0"]);
});

test("each axis also has places that are no feet", () => {
  assert.deepEqual(texts(found.slid[0]), ["0, 0, -a", "0, 0, a"]);
  assert.deepEqual(texts(found.slid[1]), ["a, -a, 0", "a, a, 0"]);
});

test("directions that depend on lengths are not offered", () => {
  assert.deepEqual(found.axes, [[0, 0, 1], [0, 1, 0]]);
  assert.equal(found.directions[0].length, 6);
  assert.equal(found.directions[1].length, 6);
});
