import assert from "node:assert/strict";
import { test } from "node:test";
import { History } from "../../../service/dh_grader/web/static/shared/history.js";

/** A cell that notes its changes in a history. */
class Cell {
  constructor(history, text = "") {
    this.history = history;
    this.text = text;
  }

  put(text) {
    this.text = text;
  }

  change(after, typed = false) {
    const before = this.text;
    this.text = after;
    this.history.note([{ target: this, before, after }], typed);
  }
}

test("steps are undone in reverse order, and redone", () => {
  const history = new History();
  const [one, other] = [new Cell(history), new Cell(history)];
  one.change("a");
  other.change("b");
  assert.equal(history.undo(), other);
  assert.equal(history.undo(), one);
  assert.equal(history.undo(), null);
  assert.deepEqual([one.text, other.text], ["", ""]);
  assert.equal(history.redo(), one);
  assert.deepEqual([one.text, other.text], ["a", ""]);
});

test("fast keys in one cell are one step", (t) => {
  let now = 0;
  t.mock.method(performance, "now", () => now);
  const history = new History();
  const cell = new Cell(history);
  for (const text of ["p", "pi", "pi/"]) cell.change(text, true);
  now = 10_000;
  cell.change("pi/2", true);
  history.undo();
  assert.equal(cell.text, "pi/");
  history.undo();
  assert.equal(cell.text, "");
});

test("another cell begins another step", () => {
  const history = new History();
  const [one, other] = [new Cell(history), new Cell(history)];
  one.change("a", true);
  other.change("b", true);
  history.undo();
  assert.deepEqual([one.text, other.text], ["a", ""]);
});

test("changes that were made together are undone together", () => {
  const history = new History();
  const cells = [new Cell(history, "1"), new Cell(history, "2"), new Cell(history, "3")];
  history.note(cells.map((cell) => ({ target: cell, before: "", after: cell.text })));
  history.undo();
  assert.deepEqual(cells.map((cell) => cell.text), ["", "", ""]);
});

test("a change clears the steps to redo, and an unchanged text is not a step", () => {
  const history = new History();
  const cell = new Cell(history);
  cell.change("a");
  history.undo();
  history.note([{ target: cell, before: "x", after: "x" }]);
  assert.equal(history.redo(), cell);
  history.undo();
  cell.change("b");
  assert.equal(history.redo(), null);
});

test("five hundred steps are remembered", () => {
  const history = new History();
  const cell = new Cell(history, "0");
  for (let i = 1; i <= 510; i += 1) cell.change(String(i));
  while (history.undo());
  assert.equal(cell.text, "10");
});
