import assert from "node:assert/strict";
import { test } from "node:test";
import { layoutOf } from "../../../service/dh_grader/web/static/student/kinds.js";
import { face, keysOf } from "../../../service/dh_grader/web/static/student/form/key_bar.js";
import {
  filled,
  isTouched,
  sentTexts,
  shownTexts,
  together,
} from "../../../service/dh_grader/web/static/student/form/part_progress.js";
import { proposedUnit, reordered, writtenOrder } from "../../../service/dh_grader/web/static/student/form/proposals.js";
import { shortNames } from "../../../service/dh_grader/web/static/student/form/rail.js";
import { nextTab } from "../../../service/dh_grader/web/static/student/form/tabs.js";

const DH = ["a", "alpha", "d", "theta"];
const cells = (...texts) => texts.map((text, i) => ({ text, prefill: i === 1 ? "0" : undefined }));

test("what the form has filled in is sent only with something the student has written", () => {
  assert.equal(isTouched(cells("", "0")), false);
  assert.equal(isTouched(cells(" ", "")), false);
  assert.equal(isTouched(cells("", "2")), true);
  assert.deepEqual(sentTexts(cells("", "0")), ["", ""]);
  assert.deepEqual(sentTexts(cells("c1", "0")), ["c1", "0"]);
  assert.deepEqual(shownTexts(cells("", ""), ["", ""]), ["", "0"]);
  assert.deepEqual(shownTexts(cells("", ""), ["c1", ""]), ["c1", ""]);
});

test("only full groups in which the student wrote count as filled", () => {
  assert.equal(filled([cells("c1", "0"), cells("", "0"), cells("c1", ""), cells("0", "0")]), 2);
});

test("rows with different verdicts are partial together", () => {
  assert.equal(together(["correct", "correct"]), "correct");
  assert.equal(together(["correct", "missing"]), "partial");
  assert.equal(together(["correct", null]), null);
});

test("only the last row of a 4×4 matrix is filled in", () => {
  const of = (size) => {
    const labels = Array.from({ length: size }, (_, i) => String(i + 1));
    return layoutOf({ kind: "transform", shape: { form: "matrix", rows: labels, columns: labels } })
      .grids[0].rows.map((row) => row.prefill);
  };
  assert.deepEqual(of(4), [undefined, undefined, undefined, ["0", "0", "0", "1"]]);
  assert.deepEqual(of(3), [undefined, undefined, undefined]);
});

test("the unit is proposed only where texts have numbers in the other one", () => {
  assert.equal(proposedUnit("degrees_as_radians", ["-90"], "radians"), "degrees");
  assert.equal(proposedUnit("degrees_as_radians", ["cos(q1 + q2 + 90)"], "radians"), "degrees");
  assert.equal(proposedUnit("degrees_as_radians", ["180*theta1/pi"], "radians"), null);
  assert.equal(proposedUnit("degrees_as_radians", ["-90"], "degrees"), null);
  assert.equal(proposedUnit("radians_as_degrees", ["1.57"], "degrees"), "radians");
  assert.equal(proposedUnit("column_sign", ["-90"], "radians"), null);
});

test("the order of columns is read from the sentence of the report", () => {
  const told = "The columns stand in the order θ, d, a, α. Write each parameter under its own header: a, α, d, θ.";
  assert.deepEqual(writtenOrder("columns_permuted", told, DH), ["theta", "d", "a", "alpha"]);
  assert.equal(writtenOrder("columns_permuted", "Another sentence.", DH), null);
  assert.equal(writtenOrder("column_order", told, DH), null);
  assert.deepEqual(reordered(["q1", "0", "a1", "pi"], ["theta", "d", "a", "alpha"], DH), ["a1", "pi", "0", "q1"]);
});

test("keys show symbols as they are typeset, those of the cell's quantity first", () => {
  assert.deepEqual(["theta1", "d_2", "q12", "l", "alpha"].map(face), ["θ₁", "d₂", "q₁₂", "l", "α"]);
  const symbols = [{ name: "theta1", kind: "angle" }, { name: "d2", kind: "length" }];
  assert.deepEqual(keysOf(symbols, "length").slice(0, 2), ["d2", "theta1"]);
  for (const key of ["θ", "d", "π", "°", "α"]) assert.ok(keysOf(symbols, "angle").includes(key));
});

test("parts of one kind are named by their titles", () => {
  const parts = [{ kind: "dh_table", title: "T" }, { kind: "dh_row", title: "X" }, { kind: "dh_row", title: "Y" }];
  assert.deepEqual(shortNames(parts), ["Table", "X", "Y"]);
});

test("arrow keys, Home and End go round the tabs", () => {
  assert.deepEqual(["ArrowRight", "ArrowLeft", "Home", "End", "a"].map((key) => nextTab(key, 0, 3)), [
    1,
    2,
    0,
    2,
    null,
  ]);
});
