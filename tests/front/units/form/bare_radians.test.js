import assert from "node:assert/strict";
import { test } from "node:test";
import { bareRadians, inRadians } from "../../../../service/dh_grader/web/static/student/reading/bare_radians.js";

test("a plain number of 7 or more in an angle cell may be meant in degrees", () => {
  const found = ["90", "-90", "−180", " 22.5 ", "7"].map((text) => bareRadians(text, "angle", "radians"));
  assert.deepEqual(found, ["90", "90", "180", "22.5", "7"]);
});

test("other texts, other cells and degrees are no trap", () => {
  const others = ["1.57", "0", "90°", "90 deg", "pi/2", "theta1 + 90", "6.28", ""];
  assert.deepEqual(others.map((text) => bareRadians(text, "angle", "radians")), others.map(() => null));
  assert.equal(bareRadians("90", "length", "radians"), null);
  assert.equal(bareRadians("90", "angle", "degrees"), null);
  assert.match(inRadians("90"), /^90 is read as 90 rad\. For degrees, write 90°/);
});
