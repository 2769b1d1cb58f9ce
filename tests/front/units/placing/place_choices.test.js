import assert from "node:assert/strict";
import { test } from "node:test";
import {
  namedPoints,
  sumOf,
  sumText,
  xDirections,
} from "../../../../service/dh_grader/web/static/robot/placing/place_choices.js";

const isNear = (found, expected) => Math.hypot(...found.map((value, i) => value - expected[i])) < 1e-9;

test("named points are crossings, feet of common perpendiculars and given points", () => {
  const axis = [[1, 0, 0], [0, 0, 1]];
  const crossing = [[5, 0, 2], [1, 0, 0]];
  const skew = [[1, 4, -3], [1, 0, 0]];
  const slanted = [[1, 7, 0], [0.6, 0, 0.8]];
  const parallel = [[9, 9, 6], [0, 0, -1]];
  const found = namedPoints([axis, crossing, skew, slanted, parallel], 0);
  [0, 2, -3, 0, 6].forEach((z, i) => assert.ok(isNear(found[i], [1, 0, z]), `${found[i]}`));
});

test("x may be along the axes of the base and along common perpendiculars, both ways", () => {
  const axis = [[0, 0, 0], [0, 0, 1]];
  const slanted = [[0, 0, 5], [0.6, 0.8, 0]];
  const parallel = [[3, 4, 7], [0, 0, 1]];
  const found = xDirections([axis, slanted, parallel], 0);
  const lines = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-0.8, 0.6, 0], [0.6, 0.8, 0]];
  const expected = lines.flatMap((vector) => [vector, vector.map((each) => -each)]);
  assert.equal(found.length, expected.length);
  for (const each of expected) assert.ok(found.some((other) => isNear(other, each)), `${each}`);
});

test("a length is a sum of symbols, or none", () => {
  const names = ["l1", "l2", "d"];
  const values = [0.6123, 0.4871, 0.2239];
  const text = (length) => sumText(sumOf(length, values), names);
  assert.equal(text(0), "0");
  assert.equal(text(0.6123 + 0.4871), "l1 + l2");
  assert.equal(text(0.4871 - 0.6123), "-l1 + l2");
  assert.equal(text(-0.2239), "-d");
  assert.equal(sumOf(0.3, values), null);
  assert.deepEqual(sumOf(0, []), []);
});
