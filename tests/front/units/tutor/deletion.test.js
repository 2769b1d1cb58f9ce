import assert from "node:assert/strict";
import { test } from "node:test";
import { inWords } from "../../../../service/dh_grader/web/static/tutor/courses/deletion.js";

const nothing = { deleted: false, assignments: 0, learners: 0, extensions: 0, keys: 0, attempts: 0 };

test("a deletion names everything that goes, and nothing else", () => {
  assert.equal(inWords(nothing), "nothing else");
  assert.equal(
    inWords({ ...nothing, assignments: 1, extensions: 2, attempts: 1234 }),
    "1 assignment, 2 extensions, 1,234 attempts with answers and reports",
  );
  assert.equal(inWords({ ...nothing, learners: 1, keys: 3 }), "the place of 1 learner, 3 links");
});
