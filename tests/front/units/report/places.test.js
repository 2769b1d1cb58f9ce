// Places of messages in words, for tables and lists of matrices.

import assert from "node:assert/strict";
import test from "node:test";
import { matrixOf, placesInWords } from "../../../../service/dh_grader/web/static/student/report/places.js";

const CELLS = ["1", "2", "3", "4"];
const at = (row, cells = []) => cells.length ? cells.map((cell) => ({ row, cell })) : [{ row }];
const report = (labels, cells) => labels.map((label) => ({ label, cells: cells.map((each) => ({ label: each })) }));

test("rows of a table with the same cells are named together", () => {
  const rows = report(["1", "2", "e"], ["a", "alpha", "d", "theta"]);
  const places = [...at("1", ["a"]), ...at("2", ["a"]), ...at("e", ["a", "alpha", "d", "theta"])];
  assert.equal(placesInWords(places, rows), "rows 1, 2 a; row e");
  assert.equal(placesInWords(at("1", ["alpha", "d"]), rows), "row 1 α, d");
  assert.equal(placesInWords(at("2"), rows), "row 2");
});

test("a matrix is named if all its rows are meant, or all but the prefilled last one", () => {
  const rows = report(["A1.1", "A1.2", "A1.3", "A1.4", "A2.1", "A2.2", "A2.3", "A2.4"], CELLS);
  const whole = ["A1.1", "A1.2", "A1.3"].flatMap((row) => at(row, CELLS));
  assert.equal(placesInWords(whole, rows), "A1");
  assert.equal(placesInWords(at("A2.2", ["1", "3"]), rows), "A2 row 2 columns 1, 3");
  assert.equal(placesInWords([...whole, ...at("A2.1", CELLS), ...at("A2.3", CELLS)], rows), "A1; A2 rows 1, 3");
  assert.equal(placesInWords(at("A2.2", ["1"])), "A2 row 2 column 1");
});

test("the label of a row says which matrix it is of", () => {
  assert.deepEqual(["A3.1", "e", "2"].map(matrixOf), ["A3", null, null]);
});
