import assert from "node:assert/strict";
import { test } from "node:test";
import { opened } from "../../../../service/dh_grader/web/static/student/convention_line.js";

test("the convention before is that of the exercise before, also after a reload", () => {
  const first = opened(null, "scara", "standard");
  assert.equal(first.before, null);
  const second = opened(first, "planar-rr-modified", "modified");
  assert.equal(second.before, "standard");
  assert.deepEqual(opened(second, "planar-rr-modified", "modified"), second);
  assert.equal(opened(second, "rrrp-modified", "modified").before, "modified");
  assert.equal(opened(second, "scara", "standard").before, "modified");
});
