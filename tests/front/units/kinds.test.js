import assert from "node:assert/strict";
import { test } from "node:test";
import { layoutOf } from "../../../service/dh_grader/web/static/student/kinds.js";

const DH = ["a", "alpha", "d", "theta"];
const table = (convention) => ({
  kind: "dh_table",
  shape: { form: "dh_table", columns: DH, rows: ["1", "e"], convention },
});

test("the rows of a DH table are posted by the names of their columns", () => {
  const { answer, choices } = layoutOf(table("standard"));
  assert.deepEqual(answer(["a1", "0", "0", "q1", "0", "pi/2", "d2", "0"], ""), {
    rows: [{ a: "a1", alpha: "0", d: "0", theta: "q1" }, { a: "0", alpha: "pi/2", d: "d2", theta: "0" }],
  });
  assert.equal(choices, null);
});

test("in the modified convention a and alpha have the index i−1", () => {
  const indices = (convention) => layoutOf(table(convention)).grids[0].columns.map((column) => column.index);
  assert.deepEqual(indices("standard"), ["i", "i", "i", "i"]);
  assert.deepEqual(indices("modified"), ["i−1", "i−1", "i", "i"]);
});

test("a table in either convention is posted with the chosen convention", () => {
  const { answer, choices } = layoutOf(table("either"));
  assert.deepEqual(Object.keys(choices), ["", "standard", "modified"]);
  assert.equal(answer(Array(8).fill("0"), "modified").convention, "modified");
  assert.equal("convention" in answer(Array(8).fill("0"), ""), false);
});

test("the row of the end effector has a name", () => {
  assert.deepEqual(layoutOf(table("standard")).grids[0].rows.map((row) => row.spoken), ["1", "e, end effector"]);
});

test("a transform without a DH row is posted as none, whatever its cells hold", () => {
  const { answer } = layoutOf({ kind: "dh_row", shape: { form: "dh_row", columns: DH, convention: "standard" } });
  assert.deepEqual(answer(["1", "2", "3", "4"], "none"), { none: true });
  assert.deepEqual(answer(["1", "2", "3", "4"], ""), { a: "1", alpha: "2", d: "3", theta: "4" });
});

test("link transforms are a list of matrices, each a list of rows", () => {
  const shape = { form: "link_transforms", matrices: ["A1", "A2"], rows: ["1", "2"], columns: ["1", "2", "3"] };
  const { answer, grids } = layoutOf({ kind: "link_transforms", shape });
  assert.deepEqual(answer("abcdefghijkl".split(""), ""), [
    [["a", "b", "c"], ["d", "e", "f"]],
    [["g", "h", "i"], ["j", "k", "l"]],
  ]);
  assert.deepEqual(grids.map((grid) => grid.rows.map((row) => row.label)), [["A1.1", "A1.2"], ["A2.1", "A2.2"]]);
});

test("a matrix is a list of rows", () => {
  const shape = { form: "matrix", rows: ["1", "2", "3"], columns: ["1", "2", "3"] };
  const { answer } = layoutOf({ kind: "rotation", shape });
  assert.deepEqual(answer("123456789".split(""), ""), [["1", "2", "3"], ["4", "5", "6"], ["7", "8", "9"]]);
});

test("the components of a list keep their names and quantities", () => {
  const components = [{ name: "x", quantity: "length" }, { name: "y", quantity: "length" }];
  const shape = { form: "list", rows: ["1", "2"], components };
  const { answer, grids: [{ rows, columns }] } = layoutOf({ kind: "position", shape });
  assert.deepEqual(answer(["l1", "0"], ""), ["l1", "0"]);
  assert.deepEqual(rows.map(({ label, head, quantity }) => [label, head, quantity]), [
    ["1", "x", "length"],
    ["2", "y", "length"],
  ]);
  assert.equal(columns[0].head, "value");
  assert.equal(layoutOf({ kind: "euler_angles", shape }).grids[0].columns[0].head, "angle");
});

test("screw axes are six-vectors, named after their frame", () => {
  const columns = ["1", "2", "3", "4", "5", "6"];
  const of = (frame) =>
    layoutOf({ kind: "screw_axes", shape: { form: "screw_axes", rows: ["1", "2"], columns, frame } });
  assert.deepEqual(of("space").answer("abcdefghijkl".split(""), ""), ["abcdef".split(""), "ghijkl".split("")]);
  assert.deepEqual(of("space").grids[0].rows.map((row) => row.head), ["S1", "S2"]);
  assert.deepEqual(of("body").grids[0].rows.map((row) => row.head), ["B1", "B2"]);
});

test("a frame is posted with its number, and its directions are offered by name", () => {
  const columns = ["axis", "z", "origin_x", "origin_y", "origin_z", "x"];
  const shape = { form: "frames", columns, rows: ["1", "2"], joints: ["1", "2", "3"], convention: "standard" };
  const { grids: [grid], answer } = layoutOf({ kind: "frames", shape });
  assert.deepEqual(answer(["2", "+y", "0", "d1", "0", "-x", "3", "+z", "", "", "", ""], ""), [
    { frame: "1", axis: "2", z: "+y", origin: ["0", "d1", "0"], x: "-x" },
    { frame: "2", axis: "3", z: "+z", origin: ["", "", ""], x: "" },
  ]);
  assert.deepEqual(grid.columns.map(({ offers }) => offers?.length), [3, 6, undefined, undefined, undefined, 6]);
  assert.deepEqual(grid.rows.map(({ spoken }) => spoken), ["frame 1", "frame 2"]);
});

test("a slip is posted with its marks, and with the table if a cell was changed", () => {
  const given = [["a1", "0", "0", "q1"], ["0", "0", "d2", "0"]];
  const shape = { form: "find_slip", columns: DH, rows: ["1", "e"], convention: "modified", given };
  const { answer, grids: [grid], marks } = layoutOf({ kind: "find_slip", shape });
  assert.deepEqual(marks, given);
  assert.deepEqual(grid.rows.map(({ prefill }) => prefill), given);
  assert.deepEqual(answer(Array(8).fill(""), "1.alpha"), { marked: "1.alpha" });
  const rows = [{ a: "a1", alpha: "pi", d: "0", theta: "q1" }, { a: "0", alpha: "0", d: "d2", theta: "0" }];
  assert.deepEqual(answer(["a1", "pi", "0", "q1", "0", "0", "d2", "0"], ""), { table: { rows } });
});
