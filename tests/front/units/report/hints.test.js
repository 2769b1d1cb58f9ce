// Which messages have hints, and the verdict at the place of a message.

import assert from "node:assert/strict";
import { test } from "node:test";

import { hasHints, verdictAt } from "../../../../service/dh_grader/web/static/student/hints/hints.js";

const error = { code: "sign", severity: /** @type {const} */ ("error"), message: "" };

test("a mistake has hints, but not an unreadable or an empty cell, and not a remark", () => {
  assert.equal(hasHints(error, "incorrect"), true);
  assert.equal(hasHints(error, "partial"), true);
  assert.equal(hasHints(error, "unreadable"), false);
  assert.equal(hasHints(error, "missing"), false);
  assert.equal(hasHints({ ...error, severity: "info" }, "incorrect"), false);
});

test("the verdict at a place is that of the cell, the row or the part", () => {
  const cells = [{ label: "a", verdict: /** @type {const} */ ("unreadable"), feedback: [] }];
  const row = { label: "1", verdict: /** @type {const} */ ("partial"), points: 0, max_points: 1, cells, feedback: [] };
  const part = /** @type {Api.PartReport} */ (/** @type {unknown} */ ({ verdict: "incorrect", rows: [row] }));
  assert.equal(verdictAt(part, { row: "1", cell: "a" }), "unreadable");
  assert.equal(verdictAt(part, { row: "1" }), "partial");
  assert.equal(verdictAt(part, {}), "incorrect");
});
