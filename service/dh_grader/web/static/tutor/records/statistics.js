// Statistics of an exercise: correct answers by part, row and cell, misconceptions by day, identical wrong answers.

import { byId, h, message, visible } from "../../shared/dom.js";
import { daysCharts } from "./days_chart.js";
import { learningCurve } from "./learning_curve.js";
import { pair } from "../../shared/pasted_block.js";
import { layoutOf } from "../../student/kinds.js";
import { cellsInWords } from "../../student/report/places.js";
import {
  attemptsInWords,
  counted,
  failed,
  learnerName,
  learnersInWords,
  nothing,
  percent,
  query,
  showExports,
  span,
  table,
  tell,
} from "./records.js";
import { regradeForm } from "./regrade.js";
import { placed, worded, wordedFor } from "../../shared/words/words.js";
import { address, get } from "../tutor_service.js";

const exercise = byId("main", HTMLElement).dataset.exercise ?? "";
const state = byId("state", HTMLElement);
const place = byId("statistics", HTMLElement);
// The shares at which a cell gets the next colour. The cell also shows the number.
const BANDS = [0.25, 0.5, 0.75, 0.9];
// The number of misconceptions and groups that are shown; all others are folded.
const SHOWN = 12;

/** @typedef {{ title: string, isList: boolean, rows: Map<string, string>, columns: Map<string, string> }} PartNames */
/** @typedef {{ answered: number, correct: number, share?: number }} Figures */

let turn = 0;
/** @type {Map<string, PartNames>} */
let names = new Map();

async function show() {
  const mine = ++turn;
  showExports({ exercise, ...span() });
  place.setAttribute("aria-busy", "true");
  try {
    if (!names.size) names = await namesOf(exercise);
    /** @type {Api.ExerciseStatistics} */
    const told = await get(`v1/exercises/${encodeURIComponent(exercise)}/statistics${query(span())}`);
    if (mine === turn) draw(told);
  } catch (error) {
    if (mine !== turn) return;
    place.replaceChildren();
    failed(error, state);
  }
  place.removeAttribute("aria-busy");
}

/**
 * Return the names that students see for parts, rows and columns, by the labels in reports.
 *
 * @param {string} id
 */
async function namesOf(id) {
  /** @type {Api.Exercise} */
  const { parts } = await get(`v1/exercises/${encodeURIComponent(id)}`);
  return new Map(parts.map((part) => [part.id, { title: part.title, ...cellNames(layoutOf(part).grids) }]));
}

/** @param {Front.Grid[]} grids */
function cellNames(grids) {
  const [{ look, columns }] = grids;
  /** @type {[string, string][]} */
  const rows = grids.flatMap((grid) =>
    grid.rows.map(({ label, spoken, head }) => pair(label, grids.length > 1 ? spoken : head))
  );
  // The columns of a matrix have only numbers. The one column of a list is not shown.
  /** @type {[string, string][]} */
  const heads = look === "matrix" ? [] : columns.map(({ label, head }) => [label, head]);
  return { isList: look === "list", rows: new Map(rows), columns: new Map(heads) };
}

/** @param {string} part */
const titleOf = (part) => visible(names.get(part)?.title ?? part);
/** @param {string} part @param {string} label */
const rowName = (part, label) => visible(names.get(part)?.rows.get(label) || label);
/** @param {string} part @param {string} label */
const columnName = (part, label) => visible(names.get(part)?.columns.get(label) ?? cellsInWords([label]));

/** @param {Api.ExerciseStatistics} statistics */
function draw(statistics) {
  const { attempts, learners, parts, misconceptions, hints = [], identical } = statistics;
  if (!attempts) {
    tell(state, "");
    const isNarrowed = Object.values(span()).some(Boolean);
    place.replaceChildren(
      nothing(
        isNarrowed ? worded("Nobody handed in on these days") : worded("Nobody has handed in yet"),
        worded("Statistics appear here after the first recorded attempt."),
      ),
    );
    return;
  }
  tell(
    state,
    worded("{attempts} of {learners}. Every attempt counts.", {
      attempts: attemptsInWords(attempts),
      learners: learnersInWords(learners),
    }),
  );
  place.replaceChildren(
    section(
      worded("Right answers"),
      worded(
        "The share of answers that are right. An unreadable part or cell counts as an answer that is not right. If a whole table is unreadable, its rows are not counted.",
      ),
      parts.map(partShares),
    ),
    section(
      worded("Misconceptions"),
      worded(
        "How many attempts have each misconception, the most frequent first, and on which days (UTC). The sentence is an example from one of the reports. The learning curve is the share of learners who have it in their first attempt, their second one, and so on.",
      ),
      [
        misconceptions.length
          ? folded(misconceptions, slipsOf(misconceptions, statistics.learners_by_attempt ?? []))
          : h("p", {}, worded("None found.")),
      ],
    ),
    hints.length
      ? section(worded("Hints"), worded("How often learners took each step of the hints for a message."), [
        folded(hints, hintsTaken),
      ])
      : "",
    section(
      worded("Identical wrong answers"),
      worded("Several learners sent exactly the same wrong answer. This does not prove that anybody copied."),
      [
        identical.length
          ? folded(identical, (groups) => h("ul", { class: "groups" }, ...groups.map(group)))
          : h("p", {}, worded("None found.")),
      ],
    ),
  );
}

/** @param {string} title @param {string} note @param {(Front.Child | Front.Child[])[]} content */
const section = (title, note, content) =>
  h("section", {}, h("h2", {}, title), h("p", { class: "quiet" }, note), ...content);

/** @param {Api.PartFigures} figures */
function partShares({ part, rows, ...share }) {
  const told = share.share === undefined
    ? worded("nobody answered")
    : wordedFor("{share} right of {count} answer", "{share} right of {count} answers", share.answered, {
      share: percent(share.share),
      count: counted(share.answered),
    });
  const body = rows.length ? shares(part, rows) : null;
  return h(
    "section",
    { class: "card" },
    h("header", {}, h("h3", {}, titleOf(part)), h("span", { class: "badge", "data-share": band(share) }, told)),
    body,
  );
}

/**
 * Return a table with the share of correct answers for each cell and row of a part.
 *
 * @param {string} part
 * @param {Api.RowFigures[]} rows
 */
function shares(part, rows) {
  const [widest] = rows.toSorted((one, other) => other.cells.length - one.cells.length);
  const labels = widest.cells.map(({ label }) => label);
  // In a list, a row has only one cell.
  const shown = names.get(part)?.isList ? [] : labels;
  const heads = [
    worded("Row"),
    ...shown.map((label) => columnName(part, label)),
    shown.length ? worded("Whole row") : worded("Right"),
    worded("Answers"),
  ];
  const body = rows.map(({ label, cells, ...whole }) => [
    rowName(part, label),
    ...shown.map((each) => shareCell(cells.find((cell) => cell.label === each))),
    shareCell(whole),
    h("td", { class: "answers" }, counted(whole.answered)),
  ]);
  return table(worded("Shares: {part}", { part: titleOf(part) }), heads, body);
}

/** @param {Figures | undefined} figures */
function shareCell(figures) {
  if (!figures) return h("td", {});
  const told = figures.share === undefined ? "–" : percent(figures.share);
  return h(
    "td",
    {
      class: "share",
      "data-share": band(figures),
      title: worded("{count} of {all}", { count: figures.correct, all: figures.answered }),
    },
    told,
  );
}

/** @param {Pick<Figures, "share">} figures */
const band = ({ share }) => (share === undefined ? "none" : BANDS.filter((edge) => share >= edge).length);

/**
 * Return a function that draws a table of some of these misconceptions, with all charts at the same scale.
 *
 * @param {Api.MisconceptionFigures[]} misconceptions
 * @param {number[]} learners the number of learners by attempt
 */
function slipsOf(misconceptions, learners) {
  const charts = daysCharts(misconceptions.map(({ by_day: counts }) => counts));
  const most = misconceptions[0].attempts;
  /** @type {(figures: Api.MisconceptionFigures) => (string | Node)[]} */
  const row = ({ part, code, sentence, attempts, by_day: counts, by_attempt: having = [] }) => [
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
    charts.get(counts) ?? "",
    learningCurve(having, learners) ?? "",
  ];
  return (/** @type {Api.MisconceptionFigures[]} */ shown) =>
    table(
      worded("Misconceptions"),
      [worded("Misconception"), worded("Part"), worded("Attempts"), worded("Over days"), worded("Learning curve")],
      shown.map(row),
    );
}

/** @param {Api.HintFigures[]} hints */
const hintsTaken = (hints) =>
  table(
    worded("Hints"),
    [worded("Message"), worded("Part"), worded("What to look at"), worded("The rule"), worded("The rule here")],
    hints.map(({ part, code, taken }) => [h("code", {}, visible(code)), titleOf(part), ...taken.map(String)]),
  );

/** @param {Api.IdenticalAnswers} identical */
function group({ learners, attempts, wrong, among }) {
  const names = among.flatMap((learner, i) => [
    i ? ", " : "",
    h("a", { href: address(`tutor/attempts?${new URLSearchParams({ exercise, learner })}`) }, learnerName(learner)),
  ]);
  const more = learners > among.length ? ` ${worded("and {count} more", { count: learners - among.length })}` : "";
  const many = h("strong", {}, learnersInWords(learners));
  return h(
    "li",
    { class: "card" },
    h(
      "p",
      {},
      ...(attempts > learners
        ? placed(worded("{learners} in {attempts}:"), { learners: many, attempts: attemptsInWords(attempts) })
        : placed(worded("{learners}:"), { learners: many })),
      " ",
      ...names,
      more,
    ),
    h("p", { class: "quiet" }, worded("Wrong in {places}", { places: placesInWords(wrong) })),
  );
}

/**
 * Return places in words, such as "DH table: row 2 α, d; row 4 d. Pose: row 1 column 4".
 *
 * @param {string[]} places
 */
function placesInWords(places) {
  /** @type {Map<string, Map<string, string[]>>} */
  const parts = new Map();
  for (const each of places) {
    const [part, row, cell] = each.split("/");
    const rows = parts.get(part) ?? new Map();
    parts.set(part, rows.set(row, [...(rows.get(row) ?? []), columnName(part, cell)]));
  }
  /** @type {(part: string, row: [string, string[]]) => string} */
  const ofRow = (
    part,
    [row, cells],
  ) => (names.get(part)?.isList ? rowName(part, row) : `${inWords(rowName(part, row))} ${cells.join(", ")}`);
  /** @type {(part: [string, Map<string, string[]>]) => string} */
  const ofPart = ([part, rows]) => `${titleOf(part)}: ${[...rows].map((row) => ofRow(part, row)).join("; ")}`;
  return visible([...parts].map(ofPart).join(". "));
}

/** @param {string} row */
const inWords = (row) => (row.includes(" ") ? row : worded("row {row}", { row }));

/**
 * Return the first items as they are drawn, and the rest folded below.
 *
 * @template Item
 * @param {Item[]} all
 * @param {(items: Item[]) => HTMLElement} draw
 */
function folded(all, draw) {
  const [first, rest] = [all.slice(0, SHOWN), all.slice(SHOWN)];
  return [
    draw(first),
    rest.length
      ? h("details", { class: "source" }, h("summary", {}, worded("{count} more", { count: rest.length })), draw(rest))
      : null,
  ];
}

byId("filters", HTMLElement).addEventListener("submit", (event) => {
  event.preventDefault();
  show();
});
byId("filters", HTMLElement).addEventListener("change", show);
byId("regrade", HTMLElement).append(regradeForm(exercise, show));
show();
