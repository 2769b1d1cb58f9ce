import assert from "node:assert/strict";
import { test } from "node:test";
import { gapBetween, gapText, isClosed, missText } from "../../../service/dh_grader/web/static/robot/frames/gap.js";
import { takePlace } from "../../../service/dh_grader/web/static/robot/frames/label_places.js";
import { directionText, nearestAxes } from "../../../service/dh_grader/web/static/robot/placing/axis_words.js";
import { leftOutText } from "../../../service/dh_grader/web/static/robot/placing/placed_words.js";
import { viewText } from "../../../service/dh_grader/web/static/robot/frames/view_text.js";

const IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
// Turned by 90 degrees about z, at (3, 4, 0).
const QUARTER = [[0, -1, 0, 3], [1, 0, 0, 4], [0, 0, 1, 0], [0, 0, 0, 1]];
// Turned by 180 degrees about x.
const HALF = [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]];

test("a gap is a length and an angle", () => {
  const gap = gapBetween(IDENTITY, QUARTER);
  assert.equal(gap.length, 5);
  assert.ok(Math.abs(gap.turn - 90) < 1e-9);
  assert.equal(gapText(gap), "5, turned by 90°");
  assert.equal(gapText(gapBetween(IDENTITY, HALF)), "turned by 180°");
  assert.ok(!isClosed(gapBetween(IDENTITY, HALF)));
  assert.ok(isClosed(gapBetween(QUARTER, QUARTER)));
  assert.equal(gapText(gapBetween(IDENTITY, [[1, 0, 0, 0.5], ...IDENTITY.slice(1)])), "0.5");
});

test("no two labels overlap, and one without room is left out", () => {
  const label = { x: 100, y: 100, width: 30, height: 14, centre: [0.5, 0.5] };
  const taken = [];
  const places = Array.from({ length: 60 }, () => takePlace(label, taken));
  assert.deepEqual(places[0], [0.5, 0.5]);
  assert.ok(places.includes(null));
  assert.ok(taken.length > 5);
  taken.forEach((one, i) =>
    taken.slice(0, i).forEach((other) =>
      assert.ok(one.left >= other.right || other.left >= one.right || one.low >= other.high || other.low >= one.high)
    )
  );
});

test("a frame beside its goal is too low, too high, too far or short", () => {
  const at = (x, y, z) => [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z]];
  const told = (one, other) => missText(gapBetween(one, other), "mm");
  assert.equal(told(at(1, 2, 3), at(1, 2, 3.38)), "0.38 mm too low");
  assert.equal(told(at(1, 2, 3), at(0.5, 2, 2.6)), "0.5 mm too far along x₀, 0.4 mm too high");
  assert.equal(told(at(1, 2, 3), at(1, 2, 3)), "");
});

test("the text says where the tool and the frames are", () => {
  const mechanism = { tool: [3, 4, 0], frames: [IDENTITY, QUARTER] };
  const text = viewText({ frames: [IDENTITY], mechanism }, ["0", "2"], gapBetween(IDENTITY, QUARTER));
  assert.equal(
    text,
    "The tool of the robot is at (3, 4, 0). " +
      "Given frame {0}: origin (0, 0, 0), x along the base's x, z along the base's z. " +
      "Given frame {2}: origin (3, 4, 0), x along the base's y, z along the base's z. " +
      "Frame {0} of your table: origin (0, 0, 0), x along the base's x, z along the base's z. " +
      "The last frame of your table misses the tool frame: 3 m short along x₀, 4 m short along y₀, turned by 90°.",
  );
  const closed = viewText({ frames: [QUARTER], mechanism: null }, [], gapBetween(QUARTER, QUARTER));
  assert.match(closed, /lies on the tool frame\.$/);
});

test("the text says where the placed frames are, and why others are left out", () => {
  const text = viewText({ frames: null, mechanism: null, placed: [QUARTER] }, [], null, ["2"]);
  assert.equal(text, "Your frame {2}: origin (3, 4, 0), x along the base's y, z along the base's z.");
  const cell = { row: "1", column: "origin_x", error: { code: "unknown", message: "`R` is not known." } };
  const empty = { row: "2", column: "axis", error: { code: "missing", message: "Nothing is written here." } };
  assert.equal(
    leftOutText({ left_out: [cell, empty] }),
    "Frame 1, origin x: `R` is not known. The view leaves this frame out.",
  );
  assert.equal(leftOutText({ left_out: [empty] }), "");
  assert.equal(leftOutText({ left_out: [] }), "");
  assert.equal(leftOutText(undefined), "");
});

test("a click is on the nearest axes, and on none from afar", () => {
  const axes = [[[0, 0], [0, 100]], [[50, 0], [50, 100]], [[51, 0], [51, 100]]];
  assert.deepEqual(nearestAxes([5, 50], axes), [0]);
  assert.deepEqual(nearestAxes([60, 50], axes), [2, 1]);
  assert.deepEqual(nearestAxes([25, 50], axes), []);
  // Beyond its end, an axis is a point.
  assert.deepEqual(nearestAxes([0, 117], axes), [0]);
  assert.deepEqual(nearestAxes([0, 119], axes), []);
});

test("a direction is written as a student would", () => {
  assert.equal(directionText([0, -1, 0]), "-y");
  assert.equal(directionText([1, 1e-9, 0]), "+x");
  assert.equal(directionText([0.6, -1e-12, -0.8]), "[0.6, 0, -0.8]");
});
