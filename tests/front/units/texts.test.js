import assert from "node:assert/strict";
import { test } from "node:test";
import { decimal, message, number, points, visible } from "../../../service/dh_grader/web/static/shared/dom.js";
import {
  attemptsInWords,
  dayName,
  earned,
  percent,
  query,
  startOf,
} from "../../../service/dh_grader/web/static/tutor/records/records.js";

test("invisible characters are shown as code points", () => {
  assert.equal(visible("a\u202eb\u200bc"), "a[U+202E]b[U+200B]c");
  assert.equal(visible("a\nb\tθ₁ é 😀"), "a b θ₁ é 😀");
  assert.equal(visible("\u{e0041}"), "[U+E0041]");
});

test("a message without code, or with a single backtick, is one text", () => {
  assert.deepEqual(message("Check the sign."), ["Check the sign."]);
  assert.deepEqual(message("a ` b"), ["a ` b"]);
});

test("points are never rounded up to the maximum", () => {
  assert.equal(points(2, 3), "2 / 3");
  assert.equal(points(7 / 3, 3), "2.33 / 3");
  assert.equal(points(2.999, 3), "2.99 / 3");
  assert.equal(points(3, 3), "3 / 3");
  assert.equal(number(1 / 3), "0.33");
});

test("three decimals have no negative zero", () => {
  assert.deepEqual([0, -0, -0.0004, 1, -1.0006, 1e-9].map(decimal), [
    "0.000",
    "0.000",
    "0.000",
    "1.000",
    "-1.001",
    "0.000",
  ]);
});

test("a share is 100 % only if it is all", () => {
  assert.deepEqual([0, 0.004, 0.5, 0.999, 1].map(percent), ["0 %", "0 %", "50 %", "99 %", "100 %"]);
});

test("an override counts instead of the points of the report", () => {
  assert.equal(earned({ points: 2, max_points: 4 }), "2 / 4");
  assert.equal(earned({ points: 2, max_points: 4, awarded: 4.5 }), "4.5 / 4");
  assert.equal(earned({ points: 2, max_points: 4, awarded: 0 }), "0 / 4");
});

test("a query has only the parameters with a value", () => {
  assert.equal(query({ exercise: "scara", learner: "", since: undefined }), "?exercise=scara");
  assert.equal(query({ learner: "a&b=c d" }), "?learner=a%26b%3Dc+d");
  assert.equal(query({ learner: "" }), "");
});

test("a day begins at midnight of the browser, also over the end of a month", () => {
  assert.equal(startOf("2026-01-31", 1), new Date(2026, 1, 1).toISOString());
  assert.equal(startOf("2026-11-22"), new Date(2026, 10, 22).toISOString());
  assert.equal(startOf(""), "");
  assert.equal(startOf("nonsense"), "");
});

test("numbers and days are written as in English", () => {
  assert.equal(attemptsInWords(1), "1 attempt");
  assert.equal(attemptsInWords(1200), "1,200 attempts");
  assert.equal(dayName("2026-11-22"), "22 Nov 2026");
});
