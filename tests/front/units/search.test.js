// Which exercises the search of the catalogue finds.

import assert from "node:assert/strict";
import { test } from "node:test";

import { matches, wordsOf } from "../../../service/dh_grader/web/static/catalogue/search.js";

const STANFORD = wordsOf("stanford-arm Stanford arm spherical wrist standard distal RRPRRR 6dof revolute prismatic");
const BAXTER = wordsOf("Baxter's left arm RRRRRRR 7dof 7R revolute");

test("a query finds an exercise by the words that people use", () => {
  for (const query of ["", " ", "STANDARD", "distal", "spherical wrist", "Wrist arm", "rrp", "prismátic"]) {
    assert.ok(matches(STANFORD, query), query);
  }
  for (const query of ["6dof", "6 dof", "6-DOF", "6 d.o.f.", "6 degrees of freedom", "6 joints", "6-axis arm"]) {
    assert.ok(matches(STANFORD, query), query);
    assert.ok(!matches(BAXTER, query), query);
  }
  assert.ok(matches(BAXTER, "7r"));
  for (const query of ["modified", "7r", "standard modified", "dof 7"]) assert.ok(!matches(STANFORD, query), query);
});

test("a short word must begin a word", () => {
  assert.ok(!matches(["d6r"], "6r"));
  assert.ok(matches(["6r"], "6r"));
});
