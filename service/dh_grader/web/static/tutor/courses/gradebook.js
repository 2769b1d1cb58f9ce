// The gradebook of a course: learners × exercises, with a filter, and sorted by any column.

import { byId, h, number, visible } from "../../shared/dom.js";
import { failed, fieldOf, learnerName, query, tell } from "../records/records.js";
import { address, get } from "../tutor_service.js";
import { isFound } from "./learner_filter.js";
import { worded, wordedFor } from "../../shared/words/words.js";

const course = byId("main", HTMLElement).dataset.course ?? "";
const state = byId("state", HTMLElement);
const list = byId("book", HTMLElement);
// The number of learners that are shown; all others are folded.
const SHOWN = 100;

/** @type {Api.Gradebook} */
let book = { course, columns: [], rows: [] };
// The column by which the rows are sorted: -1 for the name, the number of columns for the total.
let sorting = { column: -1, descending: false };
let isWhole = false;
/** The places of the rows in alphabetical order. @type {Map<Api.GradebookRow, number>} */
let places = new Map();
// Names that belong to several learners.
let shared = new Set();

const path = `v1/courses/${encodeURIComponent(course)}`;
/** @param {string} learner */
const pageOf = (learner) => address(`tutor/courses/${course}/learner?${new URLSearchParams({ learner })}`);

async function load() {
  const assignment = fieldOf("assignment").value;
  for (const link of byId("export", HTMLElement).querySelectorAll("a")) {
    const { format = "" } = link.dataset;
    link.href = address(`${path}/gradebook${query({ assignment, format })}`);
  }
  history.replaceState(null, "", location.pathname + query({ assignment }));
  try {
    book = await get(`${path}/gradebook${query({ assignment })}`);
    const names = book.rows.map(({ name }) => name).sort();
    places = new Map(book.rows.map((row, i) => [row, i]));
    shared = new Set(names.filter((name, i) => name === names[i - 1]));
    if (sorting.column > book.columns.length) sorting = { column: -1, descending: false };
    draw();
  } catch (error) {
    list.replaceChildren();
    failed(error, state);
  }
}

/** @param {Api.GradebookRow} row @param {number} column */
const valueAt = (row, column) => (column === book.columns.length ? row.total : row.points[column] ?? -1);

/** @param {Api.GradebookRow} one @param {Api.GradebookRow} other */
function inOrder(one, other) {
  const { column, descending } = sorting;
  // The service has sorted the rows by the names of the learners.
  const by = column < 0
    ? (places.get(one) ?? 0) - (places.get(other) ?? 0)
    : valueAt(one, column) - valueAt(other, column);
  return descending ? -by : by;
}

function draw() {
  const wanted = fieldOf("name").value;
  const matches = book.rows.filter(({ name, learner, email }) => isFound([name, learner, email ?? ""], wanted)).sort(
    inOrder,
  );
  const shown = isWhole ? matches : matches.slice(0, SHOWN);
  const found = wordedFor("{count} learner", "{count} learners", matches.length);
  const all = shown.length === matches.length;
  tell(state, all ? found : worded("{found}, {count} shown", { found, count: shown.length }));
  list.replaceChildren(
    h(
      "div",
      { class: "wide", tabindex: 0, role: "region", "aria-label": worded("Gradebook") },
      h(
        "table",
        { class: "plain gradebook" },
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            head(worded("Learner"), -1),
            ...book.columns.map(({ assignment, exercise, points }, i) =>
              head(`${assignment} ${exercise}`, i, ` (${number(points)})`)
            ),
            head(worded("Total"), book.columns.length),
          ),
        ),
        h("tbody", {}, ...shown.map(row)),
        h("tfoot", {}, means(matches)),
      ),
    ),
    shown.length < matches.length
      ? h("p", { class: "pages" }, h("button", { type: "button", onclick: showAll }, worded("Show all learners")))
      : "",
  );
}

function showAll() {
  isWhole = true;
  draw();
}

/** @param {string} text @param {number} column @param {string} [more] */
function head(text, column, more = "") {
  const isSorted = sorting.column === column;
  const order = sorting.descending ? "descending" : "ascending";
  const sort = () => {
    sorting = { column, descending: isSorted ? !sorting.descending : column >= 0 };
    draw();
    list.querySelectorAll("thead button")[column < 0 ? 0 : column + 1]?.dispatchEvent(new Event("sorted"));
  };
  return h(
    "th",
    { scope: "col", "aria-sort": isSorted ? order : null },
    h(
      "button",
      { type: "button", onclick: sort, onsorted: focus },
      visible(text),
      h("span", { class: "quiet" }, more),
    ),
  );
}

/**
 * Focus the heading that has replaced the pressed heading.
 *
 * @param {Event} event
 */
function focus({ currentTarget }) {
  if (currentTarget instanceof HTMLElement) currentTarget.focus();
}

/** @param {Api.GradebookRow} learner */
function row({ learner, name, email, points, total }) {
  const more = shared.has(name) && h("span", { class: "quiet" }, " ", learnerName(email ?? learner));
  return h(
    "tr",
    {},
    h("th", { scope: "row" }, h("a", { href: pageOf(learner) }, learnerName(name)), more),
    ...points.map((earned, i) => h("td", {}, cell(learner, earned, book.columns[i]))),
    h("td", {}, h("strong", {}, number(total))),
  );
}

/** @param {string} learner @param {number | null} earned @param {Api.GradebookColumn} column */
function cell(learner, earned, { assignment, exercise }) {
  if (earned === null) return h("span", { class: "quiet" }, "–");
  const found = query({ course, assignment, exercise, learner });
  return h("a", { href: address(`tutor/attempts${found}`) }, number(earned));
}

/** @param {Api.GradebookRow[]} rows */
function means(rows) {
  /** @param {(row: Api.GradebookRow) => number | null} value */
  const mean = (value) => {
    const found = rows.map(value).filter((each) => each !== null);
    return found.length ? number(found.reduce((sum, each) => sum + each, 0) / found.length) : "–";
  };
  return h(
    "tr",
    {},
    h("th", { scope: "row" }, worded("Mean of those who handed in")),
    ...book.columns.map((_, i) => h("td", {}, mean(({ points }) => points[i]))),
    h("td", {}, mean(({ points, total }) => (points.some((each) => each !== null) ? total : null))),
  );
}

const asked = new URLSearchParams(location.search).get("assignment");
if (asked) fieldOf("assignment").value = asked;
fieldOf("assignment").addEventListener("change", load);
fieldOf("name").addEventListener("input", draw);
byId("filters", HTMLFormElement).addEventListener("submit", (event) => event.preventDefault());
load();
