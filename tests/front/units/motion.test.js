import assert from "node:assert/strict";
import { test } from "node:test";
import { between, column, dot, pictureOf, Sweep } from "../../../service/dh_grader/web/static/robot/motion.js";

// A frame turned by `angle` about z, at (x, y, 0).
const turned = (angle, x = 0, y = 0) => {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]];
};

// The planar arm with two links of lengths 2 and 1, by its textbook formulas.
const planar = ([first, second]) => {
  const elbow = [2 * Math.cos(first), 2 * Math.sin(first)];
  const hand = [elbow[0] + Math.cos(first + second), elbow[1] + Math.sin(first + second)];
  return [turned(0), turned(first, ...elbow), turned(first + second, ...hand)];
};
const service = (sets) => Promise.resolve({ table: { frames: sets.map(planar), values: sets.map((each) => [each]) } });

function close(actual, expected, tolerance = 1e-12) {
  assert.equal(actual.length, expected.length);
  actual.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) <= tolerance, `${actual} is not ${expected}`));
}

test("a column of a frame is an axis or the origin", () => {
  const frame = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [0, 0, 0, 1]];
  assert.deepEqual(column(frame, 0), [1, 5, 9]);
  assert.deepEqual(column(frame, 3), [4, 8, 12]);
  assert.equal(dot([1, 2, 3], [4, -5, 6]), 12);
});

test("an answer has a picture for each set of joint values, or none", () => {
  const answer = {
    table: { frames: ["first", "second"], values: [[], ["numbers"]] },
    mechanism: { configurations: ["one", "two"] },
  };
  assert.deepEqual(pictureOf(answer, 1), { frames: "second", values: ["numbers"], mechanism: "two", placed: null });
  assert.deepEqual(pictureOf({}), { frames: null, values: null, mechanism: null, placed: null });
});

test("half of a quarter turn is an eighth turn, and the frame stays orthonormal", () => {
  const half = between(
    { frames: [turned(0, 0, 0)], mechanism: null },
    { frames: [turned(Math.PI / 2, 2, 4)], mechanism: null },
    0.5,
  );
  const [frame] = half.frames;
  const r = Math.SQRT1_2;
  close(column(frame, 0), [r, r, 0]);
  close(column(frame, 1), [-r, r, 0]);
  close(column(frame, 2), [0, 0, 1]);
  close(column(frame, 3), [1, 2, 0]);
});

test("placed frames are interpolated, too", () => {
  const at = (x) => ({ frames: null, mechanism: null, placed: [turned(0, x, 0)] });
  close(column(between(at(1), at(3), 0.5).placed[0], 3), [2, 0, 0]);
});

test("frames that only one of two pictures has are left out", () => {
  const one = { frames: [turned(0), turned(0)], mechanism: null };
  const other = { frames: [turned(0)], mechanism: null };
  assert.equal(between(one, other, 0.5).frames.length, 1);
  assert.equal(between(one, { frames: null, mechanism: null }, 0.5).frames, null);
});

test("a mechanism keeps its base, and its axes the length 1", () => {
  const one = {
    centres: [[0, 0, 0]],
    axes: [[1, 0, 0]],
    links: [[[0, 0, 0], [0, 0, 2]]],
    base: [0, 0, 0],
    base_normal: [0, 0, 1],
    tool: [2, 0, 0],
    tool_direction: [1, 0, 0],
    frames: [turned(0)],
  };
  const frames = [turned(Math.PI / 2, 4, 8)];
  const other = { ...one, centres: [[0, 4, 0]], axes: [[0, 1, 0]], tool: [0, 2, 0], tool_direction: [0, 1, 0], frames };
  const { mechanism } = between({ frames: null, mechanism: one }, { frames: null, mechanism: other }, 0.25);
  // A quarter of the way between (1, 0) and (0, 1) is (3, 1), of length 1.
  const axis = [3 / Math.sqrt(10), 1 / Math.sqrt(10), 0];
  close(mechanism.centres[0], [0, 1, 0]);
  close(mechanism.axes[0], axis);
  close(mechanism.tool, [1.5, 0.5, 0]);
  close(mechanism.tool_direction, axis);
  assert.deepEqual(mechanism.base, [0, 0, 0]);
  close(column(mechanism.frames[0], 0), axis);
  close(column(mechanism.frames[0], 3), [1, 2, 0]);
});

test("a sweep sends three requests, each for pictures between the earlier ones", async () => {
  const asked = [];
  const request = (sets) => (asked.push(sets), service(sets));
  const sweep = new Sweep(request, [0.1, 0.2], 1, { low: -1, high: 1 });
  assert.equal(sweep.isReady, false);
  let arrived = 0;
  await sweep.load(() => (arrived += 1));
  assert.deepEqual(asked.map((sets) => sets.length), [30, 29, 29]);
  assert.equal(arrived, 3);
  // Only the joint that is swept moves, from one end of its range to the other.
  assert.ok(asked.flat().every(([first]) => first === 0.1));
  const amounts = asked.flat().map(([, second]) => second);
  close([Math.min(...amounts), Math.max(...amounts)], [-1, 1]);
  assert.equal(new Set(amounts).size, 88);
});

test("between its pictures a sweep follows the arm", async () => {
  const sweep = new Sweep(service, [0, 0.5], 0, { low: -Math.PI, high: Math.PI });
  await sweep.load(() => {});
  // The distance between a chord and its arc is the radius times step squared over 8; no radius is more than 3.
  const tolerance = (3 * (2 * Math.PI / 87) ** 2) / 8;
  for (let angle = -Math.PI; angle <= Math.PI; angle += 0.1) {
    const { frames, values } = sweep.at(angle);
    // The numbers of a row change with the joint.
    close(values[0], [angle, 0.5]);
    planar([angle, 0.5]).forEach((frame, i) => {
      close(column(frames[i], 3), column(frame, 3), tolerance);
      close(column(frames[i], 0), column(frame, 0), tolerance);
    });
  }
});

test("outside its range a sweep shows its ends", async () => {
  const sweep = new Sweep(service, [0, 0], 0, { low: 0, high: 1 });
  await sweep.load(() => {});
  close(column(sweep.at(-5).frames[1], 3), [2, 0, 0]);
  close(column(sweep.at(5).frames[1], 3), [2 * Math.cos(1), 2 * Math.sin(1), 0]);
});
