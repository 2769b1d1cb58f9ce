import assert from "node:assert/strict";
import { test } from "node:test";
import { language, placed, worded, wordedFor } from "../../../../service/dh_grader/web/static/shared/words/words.js";

test("without a dictionary, everything is English", () => {
  assert.equal(language, "en");
  assert.equal(worded("Try again"), "Try again");
});

test("values are put into their places", () => {
  assert.equal(worded("Row {row} begins on frame {frame}.", { row: 2, frame: "{1}" }), "Row 2 begins on frame {1}.");
  assert.equal(worded("{a}{a} and {b}", { a: "$&", b: "{a}" }), "$&$& and {a}");
  assert.equal(worded("a {{brace}} and {toString}"), "a {brace} and {toString}");
});

test("a count chooses the sentence", () => {
  const rows = (/** @type {number} */ count) => wordedFor("1 row", "{count} rows of {all}", count, { all: 9 });
  assert.deepEqual([0, 1, 2].map(rows), ["0 rows of 9", "1 row", "2 rows of 9"]);
});

test("elements are put into open places", () => {
  const link = { link: true };
  assert.deepEqual(placed("Open {link}.", { link }), ["Open ", link, "."]);
  assert.deepEqual(placed("{link}", { link: [link, "!"] }), ["", link, "!", ""]);
  assert.equal(placed("no {other} place", { link }).join(""), "no {other} place");
});
