import assert from "node:assert/strict";
import { test } from "node:test";
import { target, undoKey } from "../../../service/dh_grader/web/static/shared/keyboard.js";
import { blockOf, placedFrom } from "../../../service/dh_grader/web/static/shared/pasted_block.js";
import { cellsInWords } from "../../../service/dh_grader/web/static/student/report/places.js";
import { cellsOf } from "../../../service/dh_grader/web/static/student/handin/answer_cells.js";

test("a block from a spreadsheet has rows and columns", () => {
  assert.deepEqual(blockOf("a1\t0\r\na2\tpi/2\r\n"), [["a1", "0"], ["a2", "pi/2"]]);
  assert.deepEqual(blockOf("1\n2\n3"), [["1"], ["2"], ["3"]]);
  assert.deepEqual(blockOf("1\t\n\t4"), [["1", ""], ["", "4"]]);
});

test("a quoted cell loses its quotes, and a doubled one becomes single", () => {
  assert.deepEqual(blockOf('"say ""x"""\t 2 '), [['say "x"', "2"]]);
});

test("a single value, an uneven block and a table of another program are not blocks", () => {
  for (const text of ["a1", "a1\t0\na2", "[1, 2]\n[3, 4]", "1 & 2 \\\\\n3 & 4 \\\\", "1 0 0\n0 1 0", "1, 0\n0, 1"]) {
    assert.equal(blockOf(text), null, text);
  }
});

test("a block fills the cells from the cursor on, if it fits", () => {
  const rows = [["a", "b", "c"], ["d", "e", "f"]];
  assert.deepEqual(placedFrom("b", rows, [["1", "2"], ["3", "4"]]), [["b", "1"], ["c", "2"], ["e", "3"], ["f", "4"]]);
  assert.equal(placedFrom("c", rows, [["1", "2"]]), null);
  assert.equal(placedFrom("d", rows, [["1"], ["2"]]), null);
});

// Rows of three and two cells; the cursor is after the only letter of the cell.
const cell = (name, from = 1, to = from) => ({ name, input: { value: "x", selectionStart: from, selectionEnd: to } });
const press = (key, more = {}) => ({ key, ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, ...more });

test("arrows and Enter move between cells", () => {
  const [a, b, c, d, e] = ["a", "b", "c", "d", "e"].map((name) => cell(name));
  const rows = [[a, b, c], [d, e]];
  const to = (key, from, more) => target(press(key, more), from, rows)?.name ?? null;
  assert.equal(to("ArrowDown", a), "d");
  assert.equal(to("Enter", a), "d");
  assert.equal(to("Enter", d, { shiftKey: true }), "a");
  assert.equal(to("ArrowUp", e), "b");
  // The row below is shorter.
  assert.equal(to("ArrowDown", c), "e");
  assert.equal(to("ArrowUp", a), null);
  assert.equal(to("ArrowDown", a, { ctrlKey: true }), null);
  assert.equal(to("x", a), null);
});

test("the left and right arrows leave the cell only at the ends of its text", () => {
  const [left, start, whole, right] = [cell("left"), cell("start", 0), cell("whole", 0, 1), cell("right")];
  const rows = [[left, start, whole, right]];
  const to = (key, from, more) => target(press(key, more), from, rows)?.name ?? null;
  assert.equal(to("ArrowLeft", start), "left");
  assert.equal(to("ArrowRight", start), null);
  assert.equal(to("ArrowRight", left), "start");
  assert.equal(to("ArrowLeft", left), null);
  assert.equal(to("ArrowLeft", whole), "start");
  assert.equal(to("ArrowRight", whole), "right");
  assert.equal(to("ArrowRight", right), null);
  assert.equal(to("ArrowLeft", start, { shiftKey: true }), null);
});

test("the keys for undo and redo of all systems", () => {
  assert.equal(undoKey(press("z", { ctrlKey: true })), "undo");
  assert.equal(undoKey(press("Z", { metaKey: true, shiftKey: true })), "redo");
  assert.equal(undoKey(press("y", { ctrlKey: true })), "redo");
  assert.equal(undoKey(press("z")), null);
  assert.equal(undoKey(press("z", { ctrlKey: true, altKey: true })), null);
});

// Two rows of a DH table, as `layoutOf` lays them out.
const columns = ["a", "alpha", "d", "theta"].map((label) => ({ label }));
const layout = { grids: [{ columns, rows: [{}, {}] }] };

test("a recorded table fills its cells in all forms of an answer", () => {
  const cells = ["1", "0", "0", "q1", "2", "", "0", "q2"];
  const rows = [{ a: 1, alpha: "0", d: 0, theta: "q1" }, { a: "2", d: "0", theta: "q2" }];
  assert.deepEqual(cellsOf(layout, { rows, convention: "modified" }), { cells, choice: "modified" });
  const lists = [[1, "0", 0, "q1"], ["2", "", "0", "q2"]];
  assert.deepEqual(cellsOf(layout, lists), { cells, choice: "" });
});

test("a missing answer has empty cells, and the answer no row is a choice", () => {
  assert.deepEqual(cellsOf(layout, undefined), { cells: Array(8).fill(""), choice: "" });
  assert.deepEqual(cellsOf(layout, null), { cells: Array(8).fill(""), choice: "" });
  assert.equal(cellsOf(layout, { none: true }).choice, "none");
});

test("an answer that does not fit its cells fills none", () => {
  const odd = [[["1"]], { rows: [{ a: "1", b: "2" }] }, [["1", true, "3", "4"], [1, 2, 3, 4]], "1 2 3 4", [[null]]];
  for (const answer of odd) assert.equal(cellsOf(layout, answer), null, JSON.stringify(answer));
});

test("a recorded mark and a mended table fill their cells; an unknown mark fits none", () => {
  const marked = { grids: [{ columns, rows: [{ label: "1" }, { label: "e" }] }], marks: [] };
  const cells = ["1", "0", "0", "q1", "2", "0", "0", "q2"];
  const table = { rows: [["1", "0", 0, "q1"], { a: "2", alpha: 0, d: "0", theta: "q2" }] };
  assert.deepEqual(cellsOf(marked, { marked: "1.alpha, e.d", table }), { cells, choice: "1.alpha, e.d" });
  const row = "e.a, e.alpha, e.d, e.theta";
  assert.deepEqual(cellsOf(marked, { marked: ["e"] }), { cells: Array(8).fill(""), choice: row });
  assert.deepEqual(cellsOf(marked, null), { cells: Array(8).fill(""), choice: "" });
  for (const odd of ["2.alpha", 7, ["1.alpha", 3]]) assert.equal(cellsOf(marked, { marked: odd, table }), null);
  assert.equal(cellsOf(marked, { marked: "1.a", rows: [] }), null);
});

test("cells are named as the student sees them", () => {
  assert.deepEqual(["alpha", "d", "3"].map((label) => cellsInWords([label])), ["α", "d", "column 3"]);
});
