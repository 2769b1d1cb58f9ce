// The attempts at an exercise in counts: parts, rows and cells, slips by count and day, identical wrong answers.

import { h, message, visible } from "../../shared/dom.js";
import { daysCharts } from "./days_chart.js";
import { layoutOf } from "../../student/kinds.js";
import { cellName } from "../../student/messages.js";
import {
  byId,
  count,
  failed,
  learnerName,
  nothing,
  percent,
  query,
  showExports,
  span,
  table,
  tell,
} from "./records.js";
import { regradeForm } from "./regrade.js";
import { address, get } from "../tutor_service.js";

const exercise = byId("main").dataset.exercise;
const state = byId("state");
const place = byId("statistics");
// The shares from which on a cell has the next colour; the number stands in it in any case.
const BANDS = [0.25, 0.5, 0.75, 0.9];
// So many slips and groups are shown, the others are folded.
const SHOWN = 12;

let turn = 0;
let names = null;

async function show() {
  const mine = ++turn;
  showExports({ exercise, ...span() });
  place.setAttribute("aria-busy", "true");
  try {
    names ??= await namesOf(exercise);
    const told = await get(`v1/exercises/${encodeURIComponent(exercise)}/statistics${query(span())}`);
    if (mine === turn) draw(told);
  } catch (error) {
    if (mine !== turn) return;
    place.replaceChildren();
    failed(error, state);
  }
  place.removeAttribute("aria-busy");
}

/** What parts, their rows and their cells are called where students fill them in, by the labels of reports. */
async function namesOf(id) {
  const { parts } = await get(`v1/exercises/${encodeURIComponent(id)}`);
  return new Map(parts.map((part) => [part.id, { title: part.title, ...cellNames(layoutOf(part).grids) }]));
}

function cellNames(grids) {
  const [{ look, columns }] = grids;
  const rows = grids.flatMap((grid) =>
    grid.rows.map(({ label, spoken, head }) => [label, grids.length > 1 ? spoken : head])
  );
  // A list has one column, which says nothing; those of a matrix have numbers.
  const heads = look === "matrix" ? [] : columns.map(({ label, head }) => [label, head]);
  return { isList: look === "list", rows: new Map(rows), columns: new Map(heads) };
}

const titleOf = (part) => visible(names.get(part)?.title ?? part);
const rowName = (part, label) => visible(names.get(part)?.rows.get(label) || label);
const columnName = (part, label) => visible(names.get(part)?.columns.get(label) ?? cellName(label));

function draw({ attempts, learners, parts, misconceptions, identical }) {
  if (!attempts) {
    tell(state, "");
    const isNarrowed = Object.values(span()).some(Boolean);
    place.replaceChildren(
      nothing(
        isNarrowed ? "Nobody handed in on these days" : "Nobody has handed in yet",
        "Counts appear here with the first recorded attempt.",
      ),
    );
    return;
  }
  tell(
    state,
    `${count(attempts, "attempt")} of ${count(learners, "learner")}. Who was wrong three times counts three times.`,
  );
  place.replaceChildren(
    section(
      "Right answers",
      "Of the answers, one of each attempt. A part or a cell that could not be read is an answer that is not right; of a table that could not be read as a whole, no row is counted.",
      parts.map(partShares),
    ),
    section(
      "Misconceptions",
      "The attempts that have each, the commonest first, and on which days (UTC). The sentence is what one of them was told.",
      [
        misconceptions.length ? folded(misconceptions, slipsOf(misconceptions)) : h("p", {}, "None was found."),
      ],
    ),
    section(
      "Identical wrong answers",
      "Sent by several learners letter by letter. This is no proof that anybody copied.",
      [
        identical.length
          ? folded(identical, (groups) => h("ul", { class: "groups" }, ...groups.map(group)))
          : h("p", {}, "There are none."),
      ],
    ),
  );
}

const section = (title, note, content) =>
  h("section", {}, h("h2", {}, title), h("p", { class: "quiet" }, note), ...content);

function partShares({ part, rows, ...share }) {
  const told = share.share === undefined
    ? "nobody answered"
    : `${percent(share.share)} right of ${count(share.answered, "answer")}`;
  const body = rows.length ? shares(part, rows) : null;
  return h(
    "section",
    { class: "card" },
    h("header", {}, h("h3", {}, titleOf(part)), h("span", { class: "badge", "data-share": band(share) }, told)),
    body,
  );
}

/** The rows of a part with the share of each cell. */
function shares(part, rows) {
  const labels = rows.reduce((most, { cells }) => (cells.length > most.length ? cells : most), []).map(({ label }) =>
    label
  );
  // In a list, the one cell is the whole row.
  const shown = names.get(part)?.isList ? [] : labels;
  const heads = [
    "Row",
    ...shown.map((label) => columnName(part, label)),
    shown.length ? "Whole row" : "Right",
    "Answers",
  ];
  const body = rows.map(({ label, cells, ...whole }) => [
    rowName(part, label),
    ...shown.map((each) => shareCell(cells.find((cell) => cell.label === each))),
    shareCell(whole),
    h("td", { class: "answers" }, whole.answered.toLocaleString("en-GB")),
  ]);
  return table(`Shares: ${titleOf(part)}`, heads, body);
}

function shareCell(figures) {
  if (!figures) return h("td", {});
  const told = figures.share === undefined ? "–" : percent(figures.share);
  return h(
    "td",
    { class: "share", "data-share": band(figures), title: `${figures.correct} of ${figures.answered}` },
    told,
  );
}

const band = ({ share }) => (share === undefined ? "none" : BANDS.filter((edge) => share >= edge).length);

/** What draws some of all slips, by the same measures. */
function slipsOf(misconceptions) {
  const charts = daysCharts(misconceptions.map(({ by_day: counts }) => counts));
  const most = misconceptions[0].attempts;
  const row = ({ part, code, sentence, attempts, by_day: counts }) => [
    sentence
      ? h("span", { class: "slip" }, h("span", {}, ...message(sentence)), h("code", {}, visible(code)))
      : h("code", {}, visible(code)),
    titleOf(part),
    h(
      "span",
      { class: "counted" },
      String(attempts),
      h("meter", { min: 0, max: most, value: attempts, "aria-hidden": "true" }),
    ),
    charts.get(counts),
  ];
  return (shown) => table("Misconceptions", ["Misconception", "Part", "Attempts", "Over days"], shown.map(row));
}

function group({ learners, attempts, wrong, among }) {
  const names = among.flatMap((learner, i) => [
    i ? ", " : "",
    h("a", { href: address(`tutor/attempts?${new URLSearchParams({ exercise, learner })}`) }, learnerName(learner)),
  ]);
  const more = learners > among.length ? ` and ${learners - among.length} more` : "";
  return h(
    "li",
    { class: "card" },
    h(
      "p",
      {},
      h("strong", {}, count(learners, "learner")),
      attempts > learners ? ` in ${count(attempts, "attempt")}: ` : ": ",
      ...names,
      more,
    ),
    h("p", { class: "quiet" }, `Wrong in ${placesInWords(wrong)}`),
  );
}

/** Places as "DH table: row 2 α, d; row 4 d. Pose: row 1 column 4". */
function placesInWords(places) {
  const parts = new Map();
  for (const each of places) {
    const [part, row, cell] = each.split("/");
    const rows = parts.get(part) ?? parts.set(part, new Map()).get(part);
    rows.set(row, [...(rows.get(row) ?? []), columnName(part, cell)]);
  }
  const ofRow = (
    part,
    [row, cells],
  ) => (names.get(part)?.isList ? rowName(part, row) : `${inWords(rowName(part, row))} ${cells.join(", ")}`);
  const ofPart = ([part, rows]) => `${titleOf(part)}: ${[...rows].map((row) => ofRow(part, row)).join("; ")}`;
  return visible([...parts].map(ofPart).join(". "));
}

const inWords = (row) => (row.includes(" ") ? row : `row ${row}`);

/** The first of many, and the others folded below. */
function folded(all, draw) {
  const [first, rest] = [all.slice(0, SHOWN), all.slice(SHOWN)];
  return [
    draw(first),
    rest.length ? h("details", { class: "source" }, h("summary", {}, `${rest.length} more`), draw(rest)) : null,
  ];
}

byId("filters").addEventListener("submit", (event) => {
  event.preventDefault();
  show();
});
byId("filters").addEventListener("change", show);
byId("regrade").append(regradeForm(exercise, show));
show();
