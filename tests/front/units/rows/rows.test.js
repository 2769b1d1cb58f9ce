import assert from "node:assert/strict";
import { test } from "node:test";
import { axisGap, jointAfter } from "../../../../service/dh_grader/web/static/robot/rows/axis_gap.js";
import { Playback } from "../../../../service/dh_grader/web/static/robot/rows/playback.js";
import { movesOf } from "../../../../service/dh_grader/web/static/robot/rows/row_moves.js";
import { axisText, captionText } from "../../../../service/dh_grader/web/static/robot/rows/row_words.js";

// z along the base's z, at (1, 2, 3).
const FRAME = [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]];
const VALUES = [0.5, -Math.PI / 2, 0, Math.PI / 6];

test("captions name the axis, the parameter and its number, in the order of the convention", () => {
  const captions = (convention) => {
    const moves = movesOf(VALUES, convention);
    return [0, 0.5, 2, 2.5, 4].map((at) => captionText({ row: 2, at, moves, convention, unit: "m" }));
  };
  assert.deepEqual(captions("standard"), [
    "Row 2 begins on frame {1}.",
    "1 of 4: turn about z₁ by θ₂ = 30°.",
    "2 of 4: along z₁ by d₂ = 0 m, so nothing moves.",
    "3 of 4: along x₂ by a₂ = 0.5 m.",
    "4 of 4: turn about x₂ by α₂ = −90°.",
  ]);
  assert.deepEqual(captions("modified"), [
    "Row 2 begins on frame {1}.",
    "1 of 4: turn about x₁ by α₁ = −90°.",
    "2 of 4: along x₁ by a₁ = 0.5 m.",
    "3 of 4: turn about z₂ by θ₂ = 30°.",
    "4 of 4: along z₂ by d₂ = 0 m, so nothing moves.",
  ]);
});

test("z must lie on the axis of the next joint, in either direction", () => {
  const told = (joint) => axisText(1, 2, axisGap(FRAME, joint), "m");
  assert.equal(told({ centre: [1, 2, 9], axis: [0, 0, -1], slides: false }), "z₁ lies on the axis of joint 2.");
  assert.equal(
    told({ centre: [4, 6, 9], axis: [0, 0, -1], slides: false }),
    "z₁ misses the axis of joint 2: 3 m short along x₀, 4 m short along y₀.",
  );
  assert.equal(
    told({ centre: [7, 2, 3.25], axis: [1, 0, 0], slides: false }),
    "z₁ misses the axis of joint 2: 0.25 m too low, turned by 90°.",
  );
  // A sliding axis has a direction, but no place.
  assert.equal(told({ centre: [4, 6, 9], axis: [0, 0, 1], slides: true }), "z₁ lies on the axis of joint 2.");
});

test("the joint after a row depends on the convention and on a fixed row before it", () => {
  const after = (convention, joints) => joints.map((_, i) => jointAfter(i, joints, 3, convention));
  assert.deepEqual(after("standard", [1, 2, 3]), [1, 2, null]);
  assert.deepEqual(after("modified", [1, 2, 3, 0]), [0, 1, 2, null]);
  assert.deepEqual(after("standard", [0, 1, 2, 3]), [0, 1, 2, null]);
});

// Play up to `end`; return all places that are shown, and the argument of `stopped`.
function played(end, { reduced = false, still = () => false } = {}) {
  const waiting = [];
  const ask = (run) => waiting.push(run);
  Object.assign(globalThis, {
    matchMedia: () => ({ matches: reduced }),
    requestAnimationFrame: ask,
    setTimeout: ask,
    cancelAnimationFrame() {},
    clearTimeout() {},
  });
  const [places, stops] = [[], []];
  const playback = new Playback((at) => places.push(at), (isEnd) => stops.push(isEnd));
  playback.play(end, still);
  let now = performance.now();
  while (waiting.length && places.length < 1000) waiting.shift()(now += 16);
  return { places, stops };
}

test("the clock shows the end of each move, and stops at the end", () => {
  const { setTimeout, clearTimeout } = globalThis;
  try {
    const { places, stops } = played(4);
    for (const end of [1, 2, 3, 4]) assert.ok(places.includes(end));
    assert.ok(places.length > 200);
    assert.ok(places.every((at, i) => i === 0 || at > places[i - 1]));
    assert.deepEqual(stops, [true]);
    assert.ok(played(4, { still: () => true }).places.length < places.length / 2);
    // Without motion, there is one picture for each move.
    assert.deepEqual(played(4, { reduced: true }), { places: [1, 2, 3, 4], stops: [true] });
  } finally {
    Object.assign(globalThis, { setTimeout, clearTimeout });
  }
});
