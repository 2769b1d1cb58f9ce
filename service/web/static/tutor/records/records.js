// What the pages of recorded attempts share: words for numbers and moments, and what stands where there is nothing.

import { byId, h, number, points, visible } from "../../shared/dom.js";
import { address, refusal } from "../tutor_service.js";

const MOMENT = new Intl.DateTimeFormat("en-GB", { dateStyle: "medium", timeStyle: "short" });
const DAY = new Intl.DateTimeFormat("en-GB", { dateStyle: "medium", timeZone: "UTC" });

/**
 * A moment in the browser's time zone.
 *
 * @param {string} text
 */
export const moment = (text) => h("time", { datetime: text }, MOMENT.format(new Date(text)));

/**
 * A day of UTC, as 2026-11-22.
 *
 * @param {string} day
 */
export const dayName = (day) => DAY.format(new Date(`${day}T00:00:00Z`));

/**
 * The name of a learner, whose letters turn nothing around them.
 *
 * @param {string} learner
 */
export const learnerName = (learner) => h("bdi", {}, visible(learner));

/** @param {number} many @param {string} noun */
export const count = (many, noun) => `${many.toLocaleString("en-GB")} ${noun}${many === 1 ? "" : "s"}`;

/**
 * A share in whole per cent: 100 of all alone.
 *
 * @param {number} share
 */
export const percent = (share) => `${share < 1 ? Math.min(Math.round(100 * share), 99) : 100} %`;

/**
 * The points that count, and what a tutor has said to them.
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
 * A query of those parameters that have a value.
 *
 * @param {Record<string, string | undefined>} parameters
 */
export function query(parameters) {
  const given = new URLSearchParams();
  for (const [name, value] of Object.entries(parameters)) if (value) given.append(name, value);
  return given.size ? `?${given}` : "";
}

/**
 * The first moment of a day of the browser's calendar, `later` days after it; "" where there is none.
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

/** The span of time that the fields "since" and "until" name; both days belong to it. */
export const span = () => ({ since: startOf(fieldOf("since").value), until: startOf(fieldOf("until").value, 1) });

/**
 * Lead the links of the export to the attempts of a filter; a gradebook needs an exercise.
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
 * Say why what was asked for is not to be had.
 *
 * @param {unknown} error
 * @param {HTMLElement} state
 */
export function failed(error, state) {
  state.textContent = visible(refusal(error));
  state.classList.add("refused");
}

/**
 * Say how it is, without a refusal.
 *
 * @param {HTMLElement} state
 * @param {string} text
 */
export function tell(state, text) {
  state.classList.remove("refused");
  state.textContent = visible(text);
}

/**
 * What stands where a list or a count has nothing in it.
 *
 * @param {string} title
 * @param {string} text
 */
export const nothing = (title, text) =>
  h("div", { class: "empty" }, h("h2", {}, title), h("p", { class: "quiet" }, text));

/**
 * A table in a box that scrolls by itself: heads, and rows of cells of which the first is their head.
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
