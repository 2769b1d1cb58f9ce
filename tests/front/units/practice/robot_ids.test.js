import assert from "node:assert/strict";
import { test } from "node:test";
import { inConvention, robotOf, slipIn } from "../../../../service/dh_grader/web/static/student/practice/robot_ids.js";

test("the id of a robot has its level and its convention", () => {
  assert.deepEqual(robotOf("practice-2-modified~k3f9"), { level: 2, convention: "modified" });
  for (const id of ["scara", "practice-5-standard~a", "practice-2-standard", "practice-2-standard~A", null]) {
    assert.equal(robotOf(id), null);
  }
  assert.equal(inConvention("practice-2-modified~k3f9", "standard"), "practice-2-standard~k3f9");
});

/** @param {string} label @param {string} column */
const slip = (label, column) => {
  const cells = ["a", "alpha", "d", "theta"].map((each) => ({
    label: each,
    verdict: each === column ? "incorrect" : "correct",
  }));
  return /** @type {Api.Report} */ (/** @type {unknown} */ ({ parts: [{ rows: [{ label, cells }] }] }));
};

test("the next robot has the situation of the first slip", () => {
  assert.equal(slipIn(slip("1", "d"), []), "offset");
  assert.equal(slipIn(slip("2", "theta"), []), "turned");
  assert.equal(slipIn(slip("2", "d"), [2]), "sliding");
  assert.equal(slipIn(slip("2", "alpha"), []), "parallel");
  assert.equal(slipIn(slip("2", ""), []), null);
});
