// The regrade of an exercise: first a preview of the changes with their reasons, then the regrade itself.

import { h, message, number, points } from "../../shared/dom.js";
import { count, failed, learnerName, query, span, table, tell } from "./records.js";
import { address, pause, sendPatiently } from "../tutor_service.js";

// How many changes are listed.
const MOST_SHOWN = 200;
// Seconds to wait while other processes regrade the last attempts.
const OTHERS = 1;

/**
 * Return the form; it calls `done` after it has written reports.
 *
 * @param {string} exercise
 * @param {() => void} done
 */
export function regradeForm(exercise, done) {
  const state = h("p", { class: "state-line", role: "status" });
  const bar = h("progress", { max: 1, value: 0, hidden: true, "aria-label": "Attempts regraded" });
  const changes = h("div", {});
  const preview = h("button", { type: "button", onclick: () => run(false) }, "Preview regrade");
  const write = h("button", { type: "button", hidden: true, onclick: () => run(true) }, "Write the new reports");
  const stop = h("button", { type: "button", hidden: true, onclick: () => (isStopped = true) }, "Stop");
  let isStopped = false;

  /** @param {boolean} apply */
  async function run(apply) {
    isStopped = false;
    preview.disabled = write.disabled = true;
    stop.hidden = bar.hidden = false;
    bar.removeAttribute("value");
    tell(state, apply ? "Writing …" : "Grading …");
    const focused = document.activeElement instanceof HTMLElement ? document.activeElement : preview;
    try {
      const { graded, changed, left } = await allSteps(apply);
      told(apply, graded, changed, left);
      write.hidden = apply ? !left : !graded;
      if (apply) done();
    } catch (error) {
      failed(error, state);
    }
    preview.disabled = write.disabled = false;
    stop.hidden = bar.hidden = true;
    if (document.activeElement === document.body) (focused.hidden ? preview : focused).focus();
  }

  /**
   * Send requests until no attempt is left. The service works for about a second on each.
   *
   * @param {boolean} apply
   */
  async function allSteps(apply) {
    const changed = [];
    let graded = 0;
    let cursor;
    // On the page of a course, only its attempts.
    const { course } = span();
    const path = `v1/exercises/${encodeURIComponent(exercise)}/regrade${query({ course })}`;
    for (;;) {
      const step = await sendPatiently(path, {
        apply,
        ...(cursor ? { cursor } : {}),
      });
      graded += step.regraded;
      changed.push(...step.changes);
      bar.value = graded / Math.max(graded + step.left, 1);
      cursor = step.next;
      if (!cursor || isStopped) return { graded, changed, left: cursor ? step.left : 0 };
      if (!step.regraded) await pause(OTHERS);
    }
  }

  /** @param {boolean} apply @param {number} graded @param {Api.AttemptChange[]} changed @param {number} left */
  function told(apply, graded, changed, left) {
    const kept = changed.filter(({ awarded }) => awarded !== undefined).length;
    const ofWhich = kept ? `; ${kept} of these would keep the overridden mark` : "";
    const stopped = left ? ` Stopped: ${count(left, "attempt")} left.` : "";
    if (apply) tell(state, `Regraded: ${count(graded, "attempt")}. The earlier reports are kept.${stopped}`);
    else if (!graded) tell(state, "All attempts were graded by this version of the exercise and of the program.");
    else {tell(
        state,
        `${
          count(graded, "attempt")
        } graded by another version; ${changed.length} would change${ofWhich}. Nothing is written yet.${stopped}`,
      );}
    changes.replaceChildren(...(changed.length ? [list(changed)] : []));
  }

  /** @param {Api.AttemptChange[]} changed */
  function list(changed) {
    const rows = changed.slice(0, MOST_SHOWN).map((
      { id, learner, ordinal, before, after, max_points: most, awarded, reasons },
    ) => [
      h(
        "a",
        { href: address(`tutor/attempts/${encodeURIComponent(id)}`) },
        learnerName(learner),
        h("span", { class: "aloud" }, `, attempt ${ordinal ?? "that does not count"}`),
      ),
      String(ordinal ?? "–"),
      `${points(before, most).split(" / ")[0]} → ${points(after, most)}`,
      h(
        "span",
        {},
        ...message(reasons.join("; ") || "the rule for late attempts"),
        awarded === undefined ? "" : `; the overridden mark ${number(awarded)} stays`,
      ),
    ]);
    const more = changed.length - rows.length;
    const all = table("Changes", ["Learner", "No.", "Points", "Why"], rows);
    return h("div", {}, all, more > 0 ? h("p", { class: "quiet" }, `and ${more} more`) : null);
  }

  return h(
    "div",
    {},
    h(
      "p",
      { class: "quiet" },
      "Grade again all attempts that were graded by another version of the exercise or of the program, for example after a correction. Overridden marks and the earlier reports are kept.",
    ),
    h("p", { class: "choices" }, preview, write, stop),
    bar,
    state,
    changes,
  );
}
