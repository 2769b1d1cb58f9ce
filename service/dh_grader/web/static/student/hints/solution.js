// The model solution beside the student's own answers: after full marks, or as the assignment allows.

import { h, visible } from "../../shared/dom.js";
import { typeset, typesetMessage } from "../../typeset/names.js";
import { cellsOf } from "../handin/answer_cells.js";
import { layoutOf } from "../kinds.js";
import { withScrollSign } from "../form/scroll_sign.js";
import { placed, worded } from "../../shared/words/words.js";

const NOTE = worded(
  "Entries that are written differently are marked. Both may be right: the same value has many forms, and many choices of frames are valid.",
);

/**
 * Add a button for the solution below an exercise with full marks, until the answers change.
 *
 * @param {Front.HintHost} host
 * @param {Front.PartView[]} parts
 * @param {Api.Report} report
 */
export function offerSolution(host, parts, report) {
  for (const old of host.bar.element.parentElement?.querySelectorAll(".solution-beside") ?? []) old.remove();
  const { handIn, exercise, service, answers, angleUnit } = host;
  const isFull = exercise.parts.every(({ id }) =>
    report.parts.some((each) => each.part === id && each.verdict === "correct")
  );
  if (handIn ? !handIn.own.exercise.shows_solution : !isFull) return;
  const note = h("p", { class: "quiet", role: "status" });
  const offer = h("div", { class: "choices solution-beside" });
  // The solution is in the page above the bar, because the bar covers the page.
  const place = h("section", { class: "card choices solution-beside" });
  const show = async () => {
    try {
      const { parts: model } = handIn
        ? await service.assignedSolution(handIn.path, handIn.own.exercise.exercise)
        : await service.solution(exercise.id, { answers, angle_unit: angleUnit });
      place.replaceChildren(...besides(exercise, model, answers));
      host.bar.element.before(place);
      offer.remove();
      const head = place.querySelector("h3");
      head?.focus({ preventScroll: true });
      place.scrollIntoView({ block: "start" });
    } catch (error) {
      note.textContent = visible(error.message);
    }
  };
  const button = h(
    "button",
    { type: "button", class: "quiet-button", onclick: show },
    worded("Compare with the model solution"),
  );
  offer.append(button, note);
  host.bar.element.append(offer);
  const close = () => {
    offer.remove();
    place.remove();
  };
  for (const { input } of parts.flatMap(({ cells }) => cells)) input.addEventListener("input", close, { once: true });
}

/**
 * Return elements with the student's answer to each part beside the model answer.
 *
 * @param {Api.Exercise | null} exercise
 * @param {Api.PartSolution[]} model
 * @param {Record<string, unknown>} answers
 */
export function besides(exercise, model, answers) {
  const symbols = new Set((exercise?.symbols ?? []).map(({ name }) => name));
  return [
    ...model.flatMap(({ part, title, answer, text }) => {
      const shape = exercise?.parts.find(({ id }) => id === part);
      const layout = shape ? layoutOf(shape) : null;
      const own = answers[part] ?? null;
      const [mine, theirs] = layout ? [cellsOf(layout, own), cellsOf(layout, answer)] : [null, null];
      const boxes = layout && mine && theirs && !layout.marks && own !== null
        ? pairs(layout, mine.cells, theirs.cells, symbols)
        : [{ title: "", yours: plain(own), model: plain(text) }];
      return [
        h("h3", { tabindex: -1 }, ...typesetMessage(visible(title), symbols)),
        ...boxes.map(({ title, yours, model }) =>
          h(
            "div",
            { class: "side-by-side" },
            h("section", {}, h("h4", {}, ...yoursOf(title)), ...yours),
            h("section", {}, h("h4", {}, ...modelOf(title)), ...model),
          )
        ),
      ];
    }),
    h("p", { class: "quiet" }, NOTE),
  ];
}

/** @param {string} name of a matrix, or none */
const yoursOf = (name) =>
  name ? placed(worded("{name}, yours"), { name: typeset(visible(name)) }) : [worded("Your answer")];

/** @param {string} name of a matrix, or none */
const modelOf = (name) =>
  name ? placed(worded("{name}, model"), { name: typeset(visible(name)) }) : [worded("Model solution")];

/** @param {unknown} answer */
function plain(answer) {
  if (answer === null) return [h("p", { class: "quiet" }, worded("Nothing."))];
  const text = typeof answer === "string" ? answer : JSON.stringify(answer, null, 1);
  return [h("pre", { tabindex: 0 }, text.split("\n").map(visible).join("\n"))];
}

/**
 * Return the student's table and the model table for each grid, with marks on entries that differ.
 *
 * @param {Front.Layout} layout
 * @param {string[]} mine
 * @param {string[]} theirs
 * @param {Set<string>} symbols
 */
function pairs({ grids }, mine, theirs, symbols) {
  let from = 0;
  return grids.map((grid) => {
    const [own, model] = [mine, theirs].map((texts) =>
      texts.slice(from, from + grid.rows.length * grid.columns.length)
    );
    from += own.length;
    return {
      title: grids.length > 1 ? grid.title : "",
      yours: [cellTable(grid, own, model, symbols)],
      model: [cellTable(grid, model, own, symbols)],
    };
  });
}

/**
 * Return the table of a grid; a matrix has brackets instead of headings.
 *
 * @param {Front.Grid} grid
 * @param {string[]} cells
 * @param {string[]} others
 * @param {Set<string>} symbols
 */
function cellTable({ rows, columns, look }, cells, others, symbols) {
  const isMatrix = look === "matrix";
  const same = (/** @type {string} */ text = "") => text.replace(/\s+/gu, "");
  const heads = columns.map(({ head }) => h("th", { scope: "col" }, h("i", {}, visible(head ?? ""))));
  const entry = (/** @type {number} */ at) =>
    h(
      "td",
      { class: same(cells[at]) === same(others[at]) ? null : "changed" },
      ...typesetMessage(visible(cells[at] ?? ""), symbols),
    );
  const box = h(
    "div",
    { class: isMatrix ? "choice-table bracketed" : "choice-table" },
    h(
      "table",
      {},
      isMatrix ? null : h("tr", {}, h("td"), ...heads),
      ...rows.map(({ head }, i) =>
        h(
          "tr",
          {},
          isMatrix ? null : h("th", { scope: "row" }, visible(head ?? "")),
          ...columns.map((_, j) => entry(i * columns.length + j)),
        )
      ),
    ),
  );
  return withScrollSign(box);
}
