// What the pages of recorded attempts share: words for numbers and moments, and what stands where there is nothing.

import { h, number, points, visible } from "../../shared/dom.js";
import { address, refusal } from "../tutor_service.js";

const MOMENT = new Intl.DateTimeFormat("en-GB", { dateStyle: "medium", timeStyle: "short" });
const DAY = new Intl.DateTimeFormat("en-GB", { dateStyle: "medium", timeZone: "UTC" });

export const byId = (id) => document.getElementById(id);

/** A moment in the browser's time zone. */
export const moment = (text) => h("time", { datetime: text }, MOMENT.format(new Date(text)));

/** A day of UTC, as 2026-11-22. */
export const dayName = (day) => DAY.format(new Date(`${day}T00:00:00Z`));

/** The name of a learner, whose letters turn nothing around them. */
export const learnerName = (learner) => h("bdi", {}, visible(learner));

export const count = (many, noun) => `${many.toLocaleString("en-GB")} ${noun}${many === 1 ? "" : "s"}`;

/** A share in whole per cent: 100 of all alone. */
export const percent = (share) => `${share < 1 ? Math.min(Math.round(100 * share), 99) : 100} %`;

/** The points that count, and what a tutor has said to them. */
export function earned({ awarded, points: reported, max_points: most }) {
  return awarded === undefined ? points(reported, most) : `${number(awarded)} / ${number(most)}`;
}

/** A query of those parameters that have a value. */
export function query(parameters) {
  const given = Object.entries(parameters).filter(([, value]) => value);
  return given.length ? `?${new URLSearchParams(given)}` : "";
}

/** The first moment of a day of the browser's calendar, `later` days after it; "" where there is none. */
export function startOf(day, later = 0) {
  if (!day) return "";
  const [year, month, date] = day.split("-").map(Number);
  const start = new Date(year, month - 1, date + later);
  return Number.isNaN(start.getTime()) ? "" : start.toISOString();
}

/** The span of time that the fields "since" and "until" name; both days belong to it. */
export const span = () => ({ since: startOf(byId("since").value), until: startOf(byId("until").value, 1) });

/** Lead the links of the export to the attempts of a filter; a gradebook needs an exercise. */
export function showExports(filter) {
  for (const link of byId("export").querySelectorAll("a")) {
    const { format } = link.dataset;
    const isBook = format === "canvas" || format === "moodle";
    const isOpen = !isBook || Boolean(filter.exercise);
    link.parentElement.hidden = !isOpen;
    byId("export").querySelector(".for-books")?.toggleAttribute("hidden", isOpen);
    link.href = address(`v1/attempts/export${query({ ...filter, format })}`);
  }
}

/** Say why what was asked for is not to be had. */
export function failed(error, state) {
  state.textContent = visible(refusal(error));
  state.classList.add("refused");
}

/** Say how it is, without a refusal. */
export function tell(state, text) {
  state.classList.remove("refused");
  state.textContent = visible(text);
}

/** What stands where a list or a count has nothing in it. */
export const nothing = (title, text) =>
  h("div", { class: "empty" }, h("h2", {}, title), h("p", { class: "quiet" }, text));

/** A table in a box that scrolls by itself: heads, and rows of cells of which the first is their head. */
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
