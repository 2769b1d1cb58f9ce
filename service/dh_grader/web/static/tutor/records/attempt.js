// The page of a recorded attempt: the answers, the reports and the overridden mark.

import { byId, h, number, points, visible } from "../../shared/dom.js";
import { nullIfRefused } from "../../shared/service.js";
import { RecordedReport } from "./recorded_report.js";
import { earned, failed, learnerName, moment, percent, tell } from "./records.js";
import { placed, worded } from "../../shared/words/words.js";
import { address, get, send } from "../tutor_service.js";

const id = byId("main", HTMLElement).dataset.attempt ?? "";
const path = `v1/attempts/${encodeURIComponent(id)}`;
const state = byId("state", HTMLElement);
const place = byId("attempt", HTMLElement);
// The number of the learner's newest attempts that are listed.
const MOST_LISTED = "20";

async function load() {
  try {
    /** @type {Api.AttemptDetail} */
    const found = await get(path);
    const { exercise: name, variant, learner } = found.attempt;
    // If there is a variant, show this variant, because the answers are about its numbers.
    const shown = variant ? `${name}~${variant}` : name;
    /** @type {Api.Exercise | null} */
    const exercise = await get(`v1/exercises/${encodeURIComponent(shown)}`).catch(nullIfRefused);
    // After this request, the browser sends the key of HTTP Basic to all other addresses below /v1, too.
    const { attempts } = await get(
      `v1/attempts?${new URLSearchParams({ exercise: name, learner, limit: MOST_LISTED })}`,
    );
    show(found, exercise, attempts);
    tell(state, "");
  } catch (error) {
    place.replaceChildren();
    failed(error, state);
  }
}

/** @param {Api.AttemptDetail} found @param {Api.Exercise | null} exercise @param {Api.AttemptSummary[]} attempts */
function show(found, exercise, attempts) {
  const { attempt } = found;
  const title = visible(exercise?.title ?? attempt.exercise);
  byId("title", HTMLElement).textContent = title;
  document.title = `${title} · DH Grader`;
  const drawn = new RecordedReport(exercise, found.submission);
  drawn.show(found.report);
  const about = h("section", { class: "card facts", "aria-label": worded("Facts") });
  const given = new OverrideForm(attempt, (changed) => update(changed));
  /** @type {(now: Api.AttemptDetail) => void} */
  const update = (now) => {
    about.replaceChildren(facts(now, exercise, attempts));
    given.show(now);
  };
  update(found);
  place.replaceChildren(about, h("div", { class: "handed-in" }, reports(found, drawn), drawn.element), given.element);
}

/**
 * Return a field to choose between the current report and the reports that a regrade replaced.
 *
 * @param {Api.AttemptDetail} found
 * @param {RecordedReport} drawn
 */
function reports({ report, earlier_reports: earlier }, drawn) {
  if (!earlier.length) return null;
  const all = [
    { report, text: worded("Newest report: {points}", { points: points(report.points, report.max_points) }) },
    ...earlier.toReversed().map((each) => ({
      report: each.report,
      text: worded("Until {when}: {points}, version {version}", {
        when: moment(each.replaced_at).textContent ?? "",
        points: points(each.report.points, each.max_points),
        version: each.version,
      }),
    })),
  ];
  const options = all.map(({ text }, i) => h("option", { value: i }, visible(text)));
  /** @type {HTMLSelectElement} */
  const choice = h(
    "select",
    { id: "which-report", onchange: () => drawn.show(all[choice.selectedIndex].report) },
    ...options,
  );
  return h("p", { class: "field" }, h("label", { for: "which-report" }, worded("Report")), choice);
}

/** @param {Api.AttemptDetail} found @param {Api.Exercise | null} exercise @param {Api.AttemptSummary[]} attempts */
function facts({ attempt, submission, report, hints = [] }, exercise, attempts) {
  const { learner, ordinal, at, is_late: late, version, grader, variant, hint_points: cost = 0 } = attempt;
  /** @type {(query: Record<string, string>, ...text: Front.Child[]) => HTMLElement} */
  const list = (query, ...text) => h("a", { href: address(`tutor/attempts?${new URLSearchParams(query)}`) }, ...text);
  const isOld = exercise && exercise.version !== version;
  /** @type {([string, Front.Child] | false)[]} */
  const pairs = [
    [worded("Learner"), list({ learner }, learnerName(learner))],
    [worded("Exercise"), list({ exercise: attempt.exercise }, h("code", {}, attempt.exercise))],
    variant !== undefined && [
      worded("Variant"),
      h("a", { href: address(`exercises/${attempt.exercise}~${variant}`) }, h("code", {}, variant)),
    ],
    [worded("Handed in"), h("span", {}, moment(at), late ? `, ${worded("late")}` : "")],
    [
      worded("Attempt"),
      ordinal === undefined
        ? isEmpty(submission.answers)
          ? worded("does not count: it is empty")
          : worded("does not count: nothing could be read")
        : worded("no. {number}", { number: ordinal }),
    ],
    attempts.length > 1 &&
    [worded("All attempts"), h("ul", { class: "all-attempts" }, ...attempts.toReversed().map(ofLearner))],
    [worded("Points"), h("strong", {}, earned(attempt))],
    attempt.awarded !== undefined && [worded("Without the override"), points(attempt.points, attempt.max_points)],
    (late || cost > 0) && report.points > 0 &&
    [
      worded("Points in the report"),
      [
        points(report.points, report.max_points),
        cost > 0 && worded("−{points} for hints", { points: number(cost) }),
        late && report.points > cost && lateShare(attempt.points / (report.points - cost)),
      ].filter(Boolean).join(", "),
    ],
    hints.length > 0 && [worded("Hints before it"), h("ul", {}, ...hints.map(hintInWords))],
    [worded("Angles without a unit"), submission.angle_unit === "degrees" ? worded("degrees") : worded("radians")],
    [
      worded("Graded by"),
      h(
        "span",
        {},
        isOld
          ? worded("exercise {version} (not the current version), program {grader}", { version, grader })
          : worded("exercise {version}, program {grader}", { version, grader }),
      ),
    ],
  ];
  const shown = pairs.filter((pair) => pair !== false);
  return h("dl", {}, ...shown.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
}

/** @param {Api.TakenHint} hint */
function hintInWords({ part, code, row, cell, step, price }) {
  const where = [part, row, cell].filter((each) => each !== undefined).join("/");
  return h(
    "li",
    {},
    ...placed(worded("step {step} of {code} at {place}"), {
      step: String(step),
      code: h("code", {}, code),
      place: visible(where),
    }),
    price ? `, ${percent(price)}` : "",
  );
}

/**
 * Return in words the share of its points that a late attempt earns.
 *
 * @param {number} share
 */
function lateShare(share) {
  if (share > 0.999) return worded("all of it counts although it is late");
  if (Math.abs(share - 0.5) < 0.001) return worded("half of it counts because it is late");
  return worded("{share} of it counts because it is late", { share: percent(share) });
}

/**
 * Return true if an answer, or each entry of it, is blank.
 *
 * @param {unknown} answer
 * @returns {boolean}
 */
function isEmpty(answer) {
  if (answer && typeof answer === "object") return Object.values(answer).every(isEmpty);
  return String(answer ?? "").trim() === "";
}

/**
 * Return a list item for an attempt of the learner; it is a link unless the attempt is the one on this page.
 *
 * @param {Api.AttemptSummary} attempt
 */
function ofLearner({ id: other, ordinal }) {
  const name = ordinal === undefined ? "–" : String(ordinal);
  const spoken = ordinal === undefined
    ? worded("an attempt that does not count")
    : worded("no. {number}", { number: ordinal });
  if (other === id) {
    return h(
      "li",
      {},
      h("strong", { "aria-current": "true", "aria-label": worded("{attempt}, shown", { attempt: spoken }) }, name),
    );
  }
  return h(
    "li",
    {},
    h(
      "a",
      { href: address(`tutor/attempts/${encodeURIComponent(other)}${location.search}`), "aria-label": spoken },
      name,
    ),
  );
}

/** The form to override the mark, and the list of earlier overrides. */
class OverrideForm {
  /**
   * `changed` gets the attempt after each override.
   *
   * @param {Api.AttemptSummary} attempt
   * @param {(attempt: Api.AttemptDetail) => void} changed
   */
  constructor({ max_points: most }, changed) {
    this.changed = changed;
    this.points = h("input", {
      id: "points",
      type: "number",
      min: 0,
      max: most,
      step: "any",
      required: true,
      inputmode: "decimal",
    });
    this.reason = h("input", { id: "reason", type: "text", maxlength: 1000, required: true, autocomplete: "off" });
    this.author = h("input", { id: "author", type: "text", maxlength: 150, autocomplete: "name" });
    this.withdrawal = h("button", { type: "submit", value: "withdraw" }, worded("Withdraw override"));
    this.told = h("p", { class: "state-line", role: "status" });
    this.list = h("ul", { class: "given" });
    this.element = h(
      "section",
      { class: "card override", "aria-labelledby": "override-title" },
      h("h2", { id: "override-title" }, worded("Override mark")),
      h(
        "form",
        { onsubmit: (event) => this.#give(event) },
        field(worded("Points"), this.points, worded("of {points}", { points: number(most) })),
        field(worded("Reason"), this.reason, worded("recorded, but not shown to the learner")),
        field(worded("Your name"), this.author, worded("if several tutors override marks")),
        h("p", { class: "choices" }, h("button", { type: "submit" }, worded("Save")), this.withdrawal),
      ),
      this.told,
      this.list,
    );
  }

  /** @param {Api.AttemptDetail} found */
  show({ attempt, overrides }) {
    // Without an override, the field is empty, because it would round the points of the report.
    this.points.value = String(attempt.awarded ?? "");
    this.withdrawal.hidden = attempt.awarded === undefined;
    this.list.replaceChildren(...overrides.toReversed().map(override));
    this.list.hidden = !overrides.length;
  }

  /** @param {SubmitEvent} event */
  async #give(event) {
    event.preventDefault();
    const isWithdrawal = event.submitter === this.withdrawal;
    /** @type {Api.OverrideRequest} */
    const body = { reason: this.reason.value };
    if (!isWithdrawal) body.points = this.points.valueAsNumber;
    if (this.author.value.trim()) body.author = this.author.value;
    try {
      const { awarded } = await send(`${path}/override`, body);
      this.changed(await get(path));
      this.reason.value = "";
      tell(
        this.told,
        isWithdrawal
          ? worded("Override withdrawn: the points of the report count.")
          : worded("The attempt has {points} points.", { points: number(awarded) }),
      );
    } catch (error) {
      failed(error, this.told);
    }
  }
}

/** @param {string} label @param {HTMLInputElement} input @param {string} hint */
function field(label, input, hint) {
  const described = `${input.id}-hint`;
  input.setAttribute("aria-describedby", described);
  return h(
    "p",
    { class: "field" },
    h("label", { for: input.id }, label),
    input,
    h("span", { class: "quiet", id: described }, hint),
  );
}

/** @param {Api.AttemptOverride} given */
function override({ points: given, reason, author, at }) {
  return h(
    "li",
    {},
    h("strong", {}, given === undefined ? worded("Withdrawn") : worded("{points} points", { points: number(given) })),
    ": ",
    h("bdi", {}, visible(reason)),
    h("span", { class: "quiet" }, " ", h("bdi", {}, visible(author)), ", ", moment(at)),
  );
}

// Return to the list with the same filters and page.
byId("back-to-list", HTMLAnchorElement).search = location.search;
load();
