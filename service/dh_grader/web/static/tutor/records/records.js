// Helpers of the pages of recorded attempts: numbers and times as text, messages, tables.

import { byId, h, number, points, visible } from "../../shared/dom.js";
import { language, wordedFor } from "../../shared/words/words.js";
import { address, refusal } from "../tutor_service.js";

// English dates as most countries write them: the day first.
const TAG = language === "en" ? "en-GB" : language;
const MOMENT = new Intl.DateTimeFormat(TAG, { dateStyle: "medium", timeStyle: "short" });
const DAY = new Intl.DateTimeFormat(TAG, { dateStyle: "medium", timeZone: "UTC" });

/**
 * Return a time in the browser's time zone.
 *
 * @param {string} text
 */
export const moment = (text) => h("time", { datetime: text }, MOMENT.format(new Date(text)));

/**
 * Return a day of UTC (such as 2026-11-22) as text.
 *
 * @param {string} day
 */
export const dayName = (day) => DAY.format(new Date(`${day}T00:00:00Z`));

/**
 * Return the name of a learner; right-to-left letters in it do not reverse the text around it.
 *
 * @param {string} learner
 */
export const learnerName = (learner) => h("bdi", {}, visible(learner));

/** Return a count with the separators of thousands of the language. @param {number} many */
export const counted = (many) => many.toLocaleString(TAG);

/** @param {number} many */
export const attemptsInWords = (many) =>
  wordedFor("{count} attempt", "{count} attempts", many, { count: counted(many) });

/** @param {number} many */
export const learnersInWords = (many) =>
  wordedFor("{count} learner", "{count} learners", many, { count: counted(many) });

/**
 * Return a share in whole per cent; only a share of 1 becomes 100.
 *
 * @param {number} share
 */
export const percent = (share) => `${share < 1 ? Math.min(Math.round(100 * share), 99) : 100} %`;

/**
 * Return the points that count: the override, if there is one, or else the points of the report.
 *
 * @param {Pick<Api.AttemptSummary, "awarded" | "points" | "max_points">} attempt
 */
export function earned({ awarded, points: reported, max_points: most }) {
  return awarded === undefined ? points(reported, most) : `${number(awarded)} / ${number(most)}`;
}

/**
 * Return a field of the page.
 *
 * @param {string} id
 * @returns {Front.FilterField}
 */
export function fieldOf(id) {
  const field = document.getElementById(id);
  if (field instanceof HTMLInputElement || field instanceof HTMLSelectElement) return field;
  throw new Error(`The page has no field with the id ${id}.`);
}

/**
 * Return the query string of all parameters that have a value.
 *
 * @param {Record<string, string | undefined>} parameters
 */
export function query(parameters) {
  const given = new URLSearchParams();
  for (const [name, value] of Object.entries(parameters)) if (value) given.append(name, value);
  return given.size ? `?${given}` : "";
}

/**
 * Return the first moment of the day that is `later` days after `day` in the browser's time zone, or "".
 *
 * @param {string} day
 * @param {number} [later]
 */
export function startOf(day, later = 0) {
  if (!day) return "";
  const [year, month, date] = day.split("-").map(Number);
  const start = new Date(year, month - 1, date + later);
  return Number.isNaN(start.getTime()) ? "" : start.toISOString();
}

/** Return the course and the assignment in the page's address, which links from their pages contain. */
export function within() {
  const asked = new URLSearchParams(location.search);
  return { course: asked.get("course") ?? "", assignment: asked.get("assignment") ?? "" };
}

/** Return the filter: course, assignment, and the time from the day in "since" to the end of the day in "until". */
export const span = () => ({
  since: startOf(fieldOf("since").value),
  until: startOf(fieldOf("until").value, 1),
  ...within(),
});

/**
 * Let the export links export the attempts of a filter. Hide links for gradebooks if no exercise is chosen.
 *
 * @param {Front.Filter} filter
 */
export function showExports(filter) {
  const place = byId("export", HTMLElement);
  for (const link of place.querySelectorAll("a")) {
    const { format } = link.dataset;
    const isBook = format === "canvas" || format === "moodle";
    const isOpen = !isBook || Boolean(filter.exercise);
    if (link.parentElement) link.parentElement.hidden = !isOpen;
    place.querySelector(".for-books")?.toggleAttribute("hidden", isOpen);
    link.href = address(`v1/attempts/export${query({ ...filter, format })}`);
  }
}

/**
 * Show why a request failed.
 *
 * @param {unknown} error
 * @param {HTMLElement} state
 */
export function failed(error, state) {
  state.textContent = visible(refusal(error));
  state.classList.add("refused");
}

/**
 * Show a message that is not an error.
 *
 * @param {HTMLElement} state
 * @param {string} text
 */
export function tell(state, text) {
  state.classList.remove("refused");
  state.textContent = visible(text);
}

/**
 * Return the element that an empty list shows.
 *
 * @param {string} title
 * @param {string} text
 */
export const nothing = (title, text) =>
  h("div", { class: "empty" }, h("h2", {}, title), h("p", { class: "quiet" }, text));

/**
 * Return a table in a box that scrolls. The first cell of each row is the row's heading.
 *
 * @param {string} name
 * @param {string[]} heads
 * @param {(string | Node)[][]} rows
 */
export function table(name, heads, rows) {
  const body = rows.map(([first, ...cells]) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, first),
      ...cells.map((cell) => (cell instanceof HTMLTableCellElement ? cell : h("td", {}, cell))),
    )
  );
  return h(
    "div",
    { class: "wide", tabindex: 0, role: "region", "aria-label": name },
    h(
      "table",
      { class: "plain" },
      h("thead", {}, h("tr", {}, ...heads.map((head) => h("th", { scope: "col" }, head)))),
      h("tbody", {}, ...body),
    ),
  );
}
