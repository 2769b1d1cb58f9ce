// The list of recorded attempts: its filters and pages, and the deletion of a learner's data.

import { byId, h } from "../../shared/dom.js";
import {
  attemptsInWords,
  counted,
  earned,
  failed,
  fieldOf,
  learnerName,
  moment,
  nothing,
  query,
  showExports,
  span,
  table,
  tell,
  within,
} from "./records.js";
import { placed, worded, wordedFor } from "../../shared/words/words.js";
import { address, get, send } from "../tutor_service.js";

const FIELDS = ["exercise", "learner", "since", "until", "counted"];
const form = byId("filters", HTMLFormElement);
const state = byId("state", HTMLElement);
const list = byId("list", HTMLElement);

// The cursors of all pages up to the current page, which are also in the address. The first page has an empty cursor.
let cursors = [""];
let turn = 0;

/** @param {string} text */
const oneLine = (text) => text.trim().replace(/\s+/g, " ");
const filter = () => ({ exercise: fieldOf("exercise").value, learner: oneLine(fieldOf("learner").value), ...span() });

async function show() {
  const mine = ++turn;
  const wanted = { ...filter(), counted: fieldOf("counted").value };
  showExports(filter());
  list.setAttribute("aria-busy", "true");
  try {
    const page = await get(`v1/attempts${query({ ...wanted, cursor: cursors.at(-1) })}`);
    if (mine === turn) draw(page, wanted);
  } catch (error) {
    if (mine !== turn) return;
    list.replaceChildren();
    failed(error, state);
  }
  list.removeAttribute("aria-busy");
}

/** @param {Api.AttemptList} page @param {Front.Filter} wanted */
function draw({ attempts, next }, wanted) {
  if (!attempts.length) {
    tell(state, "");
    const isNarrowed = Object.values(wanted).some(Boolean);
    list.replaceChildren(
      isNarrowed ? nothing(worded("No attempt matches the filters"), worded("Remove a filter.")) : nothing(
        worded("Nobody has handed in yet"),
        worded("Attempts appear here when a course records them: POST /v1/exercises/{{id}}/attempts."),
      ),
    );
    return;
  }
  const page = cursors.length;
  const found = attemptsInWords(attempts.length);
  if (next) tell(state, worded("Page {page}: {found}, and there are older ones.", { page, found }));
  else tell(state, page > 1 ? worded("Page {page}: {found}.", { page, found }) : `${found}.`);
  list.replaceChildren(
    wanted.exercise
      ? h(
        "p",
        { class: "ways-on" },
        h(
          "a",
          { href: address(`tutor/statistics/${encodeURIComponent(wanted.exercise)}`) },
          worded("Statistics and regrade of this exercise"),
        ),
      )
      : "",
    table(
      worded("Attempts"),
      [worded("When"), worded("Learner"), worded("Points"), worded("No."), worded("Exercise"), worded("Remarks")],
      attempts.map(row),
    ),
    pages(next),
  );
}

/** @param {Api.AttemptSummary} attempt */
function row(attempt) {
  const { id, exercise, learner, ordinal, at, is_late: late, awarded } = attempt;
  const remarks = [
    ordinal === undefined && worded("nothing readable"),
    late && worded("late"),
    awarded !== undefined && worded("mark overridden"),
  ];
  // The link keeps the filters, so that the attempt's page can link back to this list.
  const open = h(
    "a",
    { href: address(`tutor/attempts/${encodeURIComponent(id)}`) + location.search },
    moment(at),
    h("span", { class: "aloud" }, " ", ...placed(worded("by {learner}"), { learner: learnerName(learner) })),
  );
  return [
    open,
    learnerName(learner),
    earned(attempt),
    String(ordinal ?? "–"),
    h("code", {}, exercise),
    remarks.filter(Boolean).join(", "),
  ];
}

/** @param {string | undefined} next */
function pages(next) {
  if (!next && cursors.length === 1) return "";
  /** @type {(changed: string[]) => () => Promise<void>} */
  const turnTo = (changed) => async () => {
    cursors = changed;
    keepAddress();
    await show();
    const wide = list.querySelector(".wide");
    if (wide instanceof HTMLElement) wide.focus();
  };
  return h(
    "nav",
    { class: "pages", "aria-label": worded("Pages of the list") },
    cursors.length > 1
      ? h("button", { type: "button", onclick: turnTo(cursors.slice(0, -1)) }, worded("Newer attempts"))
      : null,
    next ? h("button", { type: "button", onclick: turnTo([...cursors, next]) }, worded("Older attempts")) : null,
  );
}

/**
 * Show the first page after the filters have changed.
 *
 * @param {Event} [event]
 */
function changed(event) {
  event?.preventDefault();
  cursors = [""];
  keepAddress();
  return show();
}

/** Put filters and page into the address, for bookmarks and for the browser's back button. */
function keepAddress() {
  const pairs = [
    ...Object.entries(within()),
    ...FIELDS.map((name) => [name, fieldOf(name).value]),
    ...cursors.map((cursor) => ["cursor", cursor]),
  ];
  const given = new URLSearchParams(pairs.filter(([, value]) => value));
  history.replaceState(null, "", location.pathname + (given.size ? `?${given}` : ""));
}

// The deletion of a learner's data. A key that is restricted to some exercises does not see this form.

const forgetForm = document.getElementById("forget");
const forgetState = () => byId("forget-state", HTMLElement);

/** @param {Event} event */
async function lookUp(event) {
  event.preventDefault();
  const learner = oneLine(fieldOf("forgotten").value);
  try {
    /** @type {Api.ForgottenData} */
    const found = await send("v1/learners/forget", { learner });
    if (!found.attempts && !found.courses) {
      return tell(forgetState(), worded("Nothing is recorded for {learner}.", { learner }));
    }
    tell(forgetState(), "");
    return confirm(found);
  } catch (error) {
    return failed(error, forgetState());
  }
}

/** @param {Api.ForgottenData} found */
const amounts = ({ attempts, earlier_reports: earlier, overrides, courses }) =>
  [
    attemptsInWords(attempts),
    earlier &&
    wordedFor("{count} earlier report", "{count} earlier reports", earlier, { count: counted(earlier) }),
    overrides && wordedFor("{count} overridden mark", "{count} overridden marks", overrides),
    courses && wordedFor("the place in {count} course", "the place in {count} courses", courses),
  ]
    .filter(Boolean)
    .join(", ");

/** @param {Api.ForgottenData} found */
function confirm(found) {
  const close = () => dialog.close();
  /** @type {HTMLDialogElement} */
  const dialog = h(
    "dialog",
    { "aria-labelledby": "forget-title", onclose: () => dialog.remove() },
    h(
      "h2",
      { id: "forget-title" },
      ...placed(worded("Forget {learner}?"), { learner: learnerName(found.learner) }),
    ),
    h("p", {}, worded("This permanently deletes {data}. Backups are not changed.", { data: amounts(found) })),
    h(
      "p",
      { class: "choices" },
      h(
        "button",
        { type: "button", class: "danger", onclick: () => forget(found.learner).then(close) },
        ...placed(worded("Delete all data of {learner}"), { learner: learnerName(found.learner) }),
      ),
      h("button", { type: "button", autofocus: true, onclick: close }, worded("Cancel")),
    ),
  );
  document.body.append(dialog);
  dialog.showModal();
}

/** @param {string} learner */
async function forget(learner) {
  try {
    /** @type {Api.ForgottenData} */
    const deleted = await send("v1/learners/forget", { learner, apply: true });
    const later = deleted.erased === false
      ? worded(
        "Another program is reading the database. The deleted text is overwritten in its files when that program ends.",
      )
      : "";
    const told = worded("Deleted for {learner}: {data}.", { learner, data: amounts(deleted) });
    tell(forgetState(), later ? `${told} ${later}` : told);
    fieldOf("forgotten").value = "";
    await changed();
  } catch (error) {
    failed(error, forgetState());
  }
}

const asked = new URLSearchParams(location.search);
for (const name of FIELDS) if (asked.has(name)) fieldOf(name).value = asked.get(name) ?? "";
cursors.push(...asked.getAll("cursor"));
form.addEventListener("submit", changed);
form.addEventListener("change", changed);
forgetForm?.addEventListener("submit", lookUp);
show();
