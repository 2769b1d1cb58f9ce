import assert from "node:assert/strict";
import { test } from "node:test";
import { lostLines } from "../../../../service/dh_grader/web/static/student/report/lost_points.js";

const lost = (code, points, message, row) => ({ code, points, message, row });

test("a loss of the whole part is a line of its own, above those of rows", () => {
  const lines = lostLines([
    lost("cells", 0.5, "α in row 2", "2"),
    lost("whole", 2, "mistakes that run through the answer"),
    lost("cells", 0.25, "d in row 3", "3"),
  ]);
  assert.deepEqual(lines, [
    ["−2", "mistakes that run through the answer"],
    ["−0.75", "−0.5: α in row 2; −0.25: d in row 3"],
  ]);
});

test("the rows of a matrix are one place, and an empty answer has no line", () => {
  const rows = [lost("cells", 0.5, "column 1 in row A1.1", "A1.1"), lost("cells", 0.5, "row A1.2", "A1.2")];
  assert.deepEqual(lostLines(rows), [["−1", "A1"]]);
  assert.deepEqual(lostLines([lost("no_answer", 4, "no answer")]), []);
});
