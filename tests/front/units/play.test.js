import assert from "node:assert/strict";
import { test } from "node:test";
import { ROBOTS } from "../../../service/dh_grader/web/static/play/robots.js";
import {
  jointCount,
  jointNumbers,
  robotOf,
  rowsOf,
  withKind,
  without,
} from "../../../service/dh_grader/web/static/play/rows.js";

const row = (kind, ...cells) => ({ kind, cells });
// A joint that turns, one that slides, one that turns.
const RPR = [row("R", "a1", "0", "0", "theta1"), row("P", "0", "pi/2", "d2", "0"), row("R", "a3", "0", "0", "theta3")];

test("fixed rows are not counted as joints", () => {
  const rows = [row("R"), row("F"), row("P")];
  assert.deepEqual(jointNumbers(rows), [1, null, 2]);
  assert.equal(jointCount(rows), 2);
});

test("a row of a pasted table is revolute or prismatic by the column of its variable", () => {
  const cells = [["a1", "0", "0", "theta1"], ["0", "-pi/2", "d2", "0"], ["0", "0", "theta3 + l", "pi/2"]];
  assert.deepEqual(rowsOf(cells), [
    row("R", "a1", "0", "0", "theta1"),
    row("P", "0", "-pi/2", "d2", "0"),
    // The service reads q3 as theta3, which here is a length.
    row("P", "0", "0", "d3 + l", "pi/2"),
  ]);
});

test("a row with both variables is revolute", () => {
  assert.deepEqual(rowsOf([["0", "0", "d1", "theta1"]]).map(({ kind }) => kind), ["R"]);
});

test("a fixed row does not interrupt the numbers of joints", () => {
  const cells = [["a1", "0", "0", "theta1"], ["0", "pi/2", "0", "0"], ["a2", "0", "0", "theta2"]];
  assert.deepEqual(rowsOf(cells).map(({ kind }) => kind), ["R", "F", "R"]);
});

test("theta1 is not theta10", () => {
  assert.deepEqual(rowsOf([["0", "0", "0", "theta10"]]).map(({ kind }) => kind), ["F"]);
});

test("a change of the kind moves the variable to the other column", () => {
  assert.deepEqual(withKind(RPR, 0, "P")[0], row("P", "a1", "0", "d1", "0"));
  assert.deepEqual(withKind(RPR, 1, "R")[1], row("R", "0", "pi/2", "0", "theta2"));
});

test("a formula stays in its cell when the kind changes", () => {
  const rows = [row("R", "0", "0", "l1 + 0.2", "theta1 + pi/2")];
  assert.deepEqual(withKind(rows, 0, "P")[0].cells, ["0", "0", "l1 + 0.2", "theta1 + pi/2"]);
});

test("removing a joint renumbers the variables of later joints", () => {
  const rows = withKind(RPR, 1, "F");
  assert.deepEqual(rows[1], row("F", "0", "pi/2", "0", "0"));
  assert.deepEqual(rows[2], row("R", "a3", "0", "0", "theta2"));
  assert.deepEqual(without(RPR, 0), [row("P", "0", "pi/2", "d1", "0"), row("R", "a3", "0", "0", "theta2")]);
});

test("adding a joint renumbers the variables of later joints", () => {
  const rows = withKind(withKind(RPR, 0, "F"), 0, "R");
  assert.deepEqual(rows, RPR);
});

test("the robots to start from have the right shape", () => {
  for (const [name, robot] of Object.entries(ROBOTS)) {
    assert.deepEqual(robotOf(structuredClone(robot)), robot, name);
    // A name ends with its structure: RRPR, or 6R.
    const [, count, letters] = name.match(/, (?:(\d)R|([RP]+))$/);
    assert.equal(robot.rows.map(({ kind }) => kind).join(""), letters ?? "R".repeat(count), name);
  }
});

test("a stored or linked robot of another shape is ignored", () => {
  const rows = [row("R", "0", "0", "0", "theta1")];
  assert.deepEqual(robotOf({ rows, unit: "x", more: 1 }), { convention: "standard", unit: "radians", rows });
  const wrong = [
    null,
    {},
    { rows: [] },
    { rows: [null] },
    { rows: [row("X", "0", "0", "0", "0")] },
    { rows: [row("R", "0", "0", "0")] },
    { rows: [row("R", 0, 0, 0, 0)] },
    { rows: Array(13).fill(rows[0]) },
    { rows: Array(11).fill(rows[0]) },
  ];
  for (const value of wrong) assert.equal(robotOf(value), null, JSON.stringify(value));
});
