// The attempts at an exercise in counts: parts, rows and cells, slips by count and day, identical wrong answers.

import { h, visible } from "./dom.js";
import { daysChart } from "./days_chart.js";
import { cellName } from "./messages.js";
import { byId, count, failed, learnerName, nothing, percent, query, showExports, span, table, tell } from "./records.js";
import { regradeForm } from "./regrade.js";
import { address, get } from "./tutor_service.js";

const exercise = byId("main").dataset.exercise;
const state = byId("state");
const place = byId("statistics");
// The shares from which on a cell has the next colour; the number stands in it in any case.
const BANDS = [0.25, 0.5, 0.75, 0.9];
// So many slips and groups are shown, the others are folded.
const SHOWN = 12;

let turn = 0;
let titles = null;

async function show() {
  const mine = ++turn;
  showExports({ exercise, ...span() });
  place.setAttribute("aria-busy", "true");
  try {
    titles ??= await titlesOf(exercise);
    const told = await get(`v1/exercises/${encodeURIComponent(exercise)}/statistics${query(span())}`);
    if (mine === turn) draw(told);
  } catch (error) {
    if (mine !== turn) return;
    place.replaceChildren();
    failed(error, state);
  }
  place.removeAttribute("aria-busy");
}

async function titlesOf(id) {
  const { parts } = await get(`v1/exercises/${encodeURIComponent(id)}`);
  return new Map(parts.map((part) => [part.id, part.title]));
}

const titleOf = (part) => visible(titles.get(part) ?? part);

function draw({ attempts, learners, parts, misconceptions, identical }) {
  if (!attempts) {
    tell(state, "");
    const isNarrowed = Object.values(span()).some(Boolean);
    place.replaceChildren(nothing(isNarrowed ? "Nobody handed in on these days" : "Nobody has handed in yet", "Counts appear here with the first recorded attempt."));
    return;
  }
  tell(state, `${count(attempts, "attempt")} of ${count(learners, "learner")}. Who was wrong three times counts three times.`);
  place.replaceChildren(
    section("Right answers", "Of those who answered; what could not be read is an answer that is not right.", parts.map(partShares)),
    section("Misconceptions", "The attempts that have each, the commonest first, and on which days (UTC).", [
      misconceptions.length ? folded(misconceptions, slipsOf(misconceptions)) : h("p", {}, "None was found."),
    ]),
    section("Identical wrong answers", "Sent by several learners letter by letter. This is no proof that anybody copied.", [
      identical.length ? folded(identical, (groups) => h("ul", { class: "groups" }, ...groups.map(group))) : h("p", {}, "There are none."),
    ]),
  );
}

const section = (title, note, content) => h("section", {}, h("h2", {}, title), h("p", { class: "quiet" }, note), ...content);

function partShares({ part, rows, ...share }) {
  const told = share.share === undefined ? "nobody answered" : `${percent(share.share)} right of ${count(share.answered, "answer")}`;
  const body = rows.length ? shares(titleOf(part), rows) : null;
  return h("section", { class: "card" }, h("header", {}, h("h3", {}, titleOf(part)), h("span", { class: "badge", "data-share": band(share) }, told)), body);
}

/** The rows of a part with the share of each cell. */
function shares(title, rows) {
  const labels = rows.reduce((most, { cells }) => (cells.length > most.length ? cells : most), []).map(({ label }) => label);
  const heads = ["Row", ...labels.map((label) => visible(cellName(label))), "Whole row"];
  const body = rows.map(({ label, cells, ...whole }) => [
    visible(label),
    ...labels.map((each) => shareCell(cells.find((cell) => cell.label === each))),
    shareCell(whole),
  ]);
  return table(`Shares: ${title}`, heads, body);
}

function shareCell(figures) {
  if (!figures) return h("td", {});
  const told = figures.share === undefined ? "–" : percent(figures.share);
  return h("td", { class: "share", "data-share": band(figures), title: `${figures.correct} of ${figures.answered}` }, told);
}

const band = ({ share }) => (share === undefined ? "none" : BANDS.filter((edge) => share >= edge).length);

/** What draws some of all slips, by the same measures. */
function slipsOf(misconceptions) {
  const days = misconceptions.flatMap(({ by_day: counts }) => Object.keys(counts)).sort();
  const most = misconceptions[0].attempts;
  const row = ({ part, code, attempts, by_day: counts }) => [
    h("code", {}, visible(code)),
    titleOf(part),
    h("span", { class: "counted" }, String(attempts), h("meter", { min: 0, max: most, value: attempts, "aria-hidden": "true" })),
    daysChart(counts, days[0], days.at(-1)),
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
    h("p", {}, h("strong", {}, count(learners, "learner")), attempts > learners ? ` in ${count(attempts, "attempt")}: ` : ": ", ...names, more),
    h("p", { class: "quiet" }, `Wrong in ${placesInWords(wrong)}`),
  );
}

/** Places as "DH table: row 2 α, d; row 4 d. Pose: row 1 column 4". */
function placesInWords(places) {
  const parts = new Map();
  for (const each of places) {
    const [part, row, cell] = each.split("/");
    const rows = parts.get(part) ?? parts.set(part, new Map()).get(part);
    rows.set(row, [...(rows.get(row) ?? []), cellName(cell)]);
  }
  const ofPart = ([part, rows]) => `${titleOf(part)}: ${[...rows].map(([row, cells]) => `row ${row} ${cells.join(", ")}`).join("; ")}`;
  return visible([...parts].map(ofPart).join(". "));
}

/** The first of many, and the others folded below. */
function folded(all, draw) {
  const [first, rest] = [all.slice(0, SHOWN), all.slice(SHOWN)];
  return [draw(first), rest.length ? h("details", { class: "source" }, h("summary", {}, `${rest.length} more`), draw(rest)) : null];
}

byId("filters").addEventListener("submit", (event) => {
  event.preventDefault();
  show();
});
byId("filters").addEventListener("change", show);
byId("regrade").append(regradeForm(exercise, show));
show();
