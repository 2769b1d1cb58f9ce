import assert from "node:assert/strict";
import { test } from "node:test";
import { fragmentOf, placeIn } from "../../../../service/dh_grader/web/static/learner/link_key.js";
import { momentIn } from "../../../../service/dh_grader/web/static/student/handin/dates.js";
import {
  attemptName,
  attemptPoints,
  attemptsInWords,
  datesInWords,
  ownState,
  pointsInWords,
  refusalInWords,
  whyClosed,
} from "../../../../service/dh_grader/web/static/student/handin/own_state.js";
import { newKey, pauseAfter } from "../../../../service/dh_grader/web/static/student/handin/pending.js";

const COURSE = { id: "robots", zone: "Europe/Berlin" };
const DUE = "2026-10-15T21:59:00Z";
const CLOSES = "2026-10-18T21:59:00Z";

test("a moment has the clocks of the course, and those of the learner if they differ", () => {
  assert.match(momentIn(DUE, "Europe/Berlin", "Europe/Rome"), /^Thu,? 15 Oct 2026,? 23:59 \S+$/);
  assert.match(momentIn(DUE, "Europe/Berlin", "Asia/Tokyo"), /15 Oct 2026,? 23:59 .* \(Fri,? 16 Oct,? 06:59 in your/);
  // The same night in winter time, and a moment with seconds.
  assert.match(momentIn("2026-10-25T01:30:05Z", "Europe/Berlin", "Europe/Berlin"), /02:30:05/);
});

test("the sentences tell what each state means", () => {
  const tell = (fields) => datesInWords(COURSE, { late_worth: 0.5, ...fields }, "Europe/Berlin");
  assert.equal(tell({ state: "open" }), "No due date.");
  assert.match(tell({ state: "open", due: DUE }), /^Due Thu\S* 15 Oct 2026,? 23:59 \S+\.$/);
  assert.match(
    tell({ state: "open", due: DUE, closes: CLOSES }),
    /Late attempts until Sun.* earn 50 % of their points\.$/,
  );
  assert.match(tell({ state: "late", due: DUE, closes: CLOSES }), /^It was due Thu.* Late attempts until Sun/);
  assert.match(tell({ state: "closed", due: DUE }), /^Closed since Thu/);
  assert.match(tell({ state: "closed", due: DUE, closes: CLOSES }), /^Closed since Sun/);
  assert.match(tell({ state: "not_open", opens: DUE }), /^Opens Thu[^.]*\.$/);
});

test("attempts and points are told without rounding up the meaning", () => {
  assert.equal(attemptsInWords({}, {}), "Attempts are not limited");
  assert.equal(attemptsInWords({ limit: 5 }, { attempts_left: 1 }), "1 of 5 attempts left");
  assert.equal(attemptsInWords({ limit: 5 }, { attempts_left: 0 }), "No attempts left");
  assert.equal(pointsInWords({ points: 10 }), "10 points, nothing handed in");
  assert.equal(pointsInWords({ points: 10, earned: 0, best: 0 }), "0 of 10 points count");
  assert.equal(pointsInWords({ points: 10, earned: 4, best: 8 }), "4 of 10 points count; best attempt: 8");
  assert.equal(attemptPoints({ points: 6, max_points: 24, is_late: true }, { points: 10 }), "2.5 of 10 points, late");
  assert.equal(attemptPoints({ points: 0, max_points: 0, is_late: false }, { points: 10 }), "0 of 10 points");
});

test("attempts are numbered in their assignment", () => {
  const attempts = [{ id: "one", ordinal: 3 }, { id: "empty" }, { id: "two", ordinal: 4 }];
  assert.equal(attemptName({ attempts }, "one"), "Attempt 1");
  assert.equal(attemptName({ attempts }, "two"), "Attempt 2");
  assert.match(attemptName({ attempts }, "empty"), /^Not counted/);
});

test("a learner hands in only while it is open and attempts are left", () => {
  const exercise = { exercise: "scara", attempts_left: 1 };
  const assignment = { id: "homework", state: "open", exercises: [exercise] };
  const view = { learner: "ada", courses: [{ ...COURSE, assignments: [assignment] }] };
  const own = ownState(view, "robots/homework", "scara");
  assert.equal(own.exercise, exercise);
  assert.equal(whyClosed(own), "");
  assert.equal(whyClosed({ ...own, exercise: {} }), "");
  assert.match(whyClosed({ ...own, exercise: { attempts_left: 0 } }), /no attempts left/);
  assert.match(whyClosed({ ...own, assignment: { state: "closed", due: DUE } }), /^Closed since/);
  for (const [path, id] of [["robots/other", "scara"], ["robots/homework", "other"], ["other/homework", "scara"]]) {
    assert.equal(ownState(view, path, id), null);
  }
});

test("the address of an exercise leads back to it, and a link or a damaged address is no exercise", () => {
  const places = [
    { path: "robots/homework", exercise: "scara" },
    { path: "robots/homework", exercise: "a b/%", attempt: "1f" },
  ];
  for (const place of places) assert.deepEqual(placeIn(fragmentOf(place)), place);
  for (const hash of ["", "#", "#dhg_abc", "#/robots/homework", "#/a/b/%zz", "#/a/b/c/d/e"]) {
    assert.equal(placeIn(hash), null);
  }
});

test("tries come less often, and keys are new", () => {
  assert.deepEqual([0, 1, 4, 5, 50].map(pauseAfter), [1, 2, 16, 30, 30]);
  assert.match(newKey(), /^[0-9a-f]{32}$/);
  assert.notEqual(newKey(), newKey());
});

test("a hand-in whose answer may have been lost is not called absent", () => {
  assert.equal(refusalInWords("It is closed.", false), "Not handed in: It is closed.");
  assert.equal(refusalInWords("A key is needed.", true), "Not confirmed: A key is needed.");
});
