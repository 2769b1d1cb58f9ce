// The regrade of an exercise: first a preview of the changes with their reasons, then the regrade itself.

import { h, message, number, points } from "../../shared/dom.js";
import { attemptsInWords, failed, learnerName, query, span, table, tell } from "./records.js";
import { worded } from "../../shared/words/words.js";
import { address, pause, sendPatiently } from "../tutor_service.js";

// The maximum number of changes that are listed.
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
  const bar = h("progress", { max: 1, value: 0, hidden: true, "aria-label": worded("Attempts regraded") });
  const changes = h("div", {});
  const force = h("input", { type: "checkbox" });
  force.addEventListener("change", () => (write.disabled = !force.checked));
  const failing = h("ul", {});
  const warning = h(
    "div",
    { class: "notice", hidden: true },
    h("p", {}, worded("The exercise fails its check. Correct its file before you regrade:")),
    failing,
    h("p", {}, h("label", {}, force, " ", worded("Regrade with it as it is"))),
  );
  const preview = h("button", { type: "button", onclick: () => run(false) }, worded("Preview regrade"));
  const write = h(
    "button",
    { type: "button", hidden: true, onclick: () => run(true) },
    worded("Write the new reports"),
  );
  const stop = h("button", { type: "button", hidden: true, onclick: () => (isStopped = true) }, worded("Stop"));
  let isStopped = false;

  /** @param {boolean} apply */
  async function run(apply) {
    isStopped = false;
    preview.disabled = write.disabled = true;
    stop.hidden = bar.hidden = false;
    bar.removeAttribute("value");
    tell(state, apply ? worded("Writing …") : worded("Grading …"));
    const focused = document.activeElement instanceof HTMLElement ? document.activeElement : preview;
    try {
      const { graded, changed, left, failures } = await allSteps(apply);
      if (!apply) warn(failures);
      told(apply, graded, changed, left);
      write.hidden = apply ? !left : !graded;
      if (apply) done();
    } catch (error) {
      failed(error, state);
    }
    preview.disabled = false;
    write.disabled = !warning.hidden && !force.checked;
    stop.hidden = bar.hidden = true;
    if (document.activeElement === document.body) (focused.hidden ? preview : focused).focus();
  }

  /** @param {string[]} failures */
  function warn(failures) {
    warning.hidden = !failures.length;
    force.checked = false;
    failing.replaceChildren(...failures.map((each) => h("li", {}, ...message(each))));
  }

  /**
   * Send requests until no attempt is left. The service works for about a second on each request.
   *
   * @param {boolean} apply
   */
  async function allSteps(apply) {
    const changed = [];
    /** @type {string[]} */
    let failures = [];
    let graded = 0;
    let cursor;
    // On a course's page, regrade only the attempts of this course.
    const { course } = span();
    const path = `v1/exercises/${encodeURIComponent(exercise)}/regrade${query({ course })}`;
    for (;;) {
      const step = await sendPatiently(path, {
        apply,
        force: apply && force.checked,
        ...(cursor ? { cursor } : {}),
      });
      failures = step.failures ?? failures;
      graded += step.regraded;
      changed.push(...step.changes);
      bar.value = graded / Math.max(graded + step.left, 1);
      cursor = step.next;
      if (!cursor || isStopped) return { graded, changed, left: cursor ? step.left : 0, failures };
      if (!step.regraded) await pause(OTHERS);
    }
  }

  /** @param {boolean} apply @param {number} graded @param {Api.AttemptChange[]} changed @param {number} left */
  function told(apply, graded, changed, left) {
    const kept = changed.filter(({ awarded }) => awarded !== undefined).length;
    const found = { attempts: attemptsInWords(graded), changed: changed.length, kept };
    let result = "";
    if (apply) result = worded("Regraded: {attempts}. The earlier reports are kept.", found);
    else if (!graded) result = worded("All attempts were graded by this version of the exercise and of the program.");
    else if (!kept) {
      result = worded(
        "{attempts} graded by another version; {changed} would change. Nothing is written yet.",
        found,
      );
    } else {
      result = worded(
        "{attempts} graded by another version; {changed} would change; {kept} of these would keep the overridden mark. Nothing is written yet.",
        found,
      );
    }
    const stopped = left ? worded("Stopped: {attempts} left.", { attempts: attemptsInWords(left) }) : "";
    tell(state, stopped ? `${result} ${stopped}` : result);
    changes.replaceChildren(...(changed.length ? [list(changed)] : []));
  }

  /** @param {Api.AttemptChange[]} changed */
  function list(changed) {
    const rows = changed.slice(0, MOST_SHOWN).map((
      { id, learner, ordinal, reasons, counted, ...ofExercise },
    ) => {
      // If an assignment sets the exercise, show the points in the assignment, as in the gradebook.
      const { before, after, max_points: most, awarded } = counted ?? ofExercise;
      return [
        h(
          "a",
          { href: address(`tutor/attempts/${encodeURIComponent(id)}`) },
          learnerName(learner),
          h(
            "span",
            { class: "aloud" },
            ", ",
            ordinal === undefined
              ? worded("an attempt that does not count")
              : worded("attempt {number}", { number: ordinal }),
          ),
        ),
        String(ordinal ?? "–"),
        `${points(before, most).split(" / ")[0]} → ${points(after, most)}`,
        h(
          "span",
          {},
          ...message(reasons.join("; ") || worded("the rule for late attempts")),
          ...(awarded === undefined
            ? []
            : ["; ", worded("the overridden mark {points} stays", { points: number(awarded) })]),
        ),
      ];
    });
    const more = changed.length - rows.length;
    const all = table(
      worded("Changes"),
      [worded("Learner"), worded("No."), worded("Points"), worded("Why")],
      rows,
    );
    return h("div", {}, all, more > 0 ? h("p", { class: "quiet" }, worded("and {count} more", { count: more })) : null);
  }

  return h(
    "div",
    {},
    h(
      "p",
      { class: "quiet" },
      worded(
        "Grade again all attempts that were graded by another version of the exercise or of the program, for example after a correction. Overridden marks and the earlier reports are kept.",
      ),
    ),
    warning,
    h("p", { class: "choices" }, preview, write, stop),
    bar,
    state,
    changes,
  );
}
