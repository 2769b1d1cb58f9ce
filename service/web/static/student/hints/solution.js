// The model solution beside the student's own answers: after full marks, or as the assignment allows.

import { h, visible } from "../../shared/dom.js";
import { typesetMessage } from "../../typeset/names.js";
import { cellsOf } from "../handin/answer_cells.js";
import { layoutOf } from "../kinds.js";
import { worded } from "../../shared/words/words.js";

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
  host.bar.element.querySelector(".solution-beside")?.remove();
  const { handIn, exercise, service, answers, angleUnit } = host;
  const isFull = exercise.parts.every(({ id }) =>
    report.parts.some((each) => each.part === id && each.verdict === "correct")
  );
  if (handIn ? !handIn.own.exercise.shows_solution : !isFull) return;
  const note = h("p", { class: "quiet", role: "status" });
  const place = h("div", { class: "choices solution-beside" });
  const show = async () => {
    try {
      const { parts: model } = handIn
        ? await service.assignedSolution(handIn.path, handIn.own.exercise.exercise)
        : await service.solution(exercise.id, { answers, angle_unit: angleUnit });
      place.replaceChildren(...besides(exercise, model, answers));
      place.querySelector("h3")?.focus();
    } catch (error) {
      note.textContent = visible(error.message);
    }
  };
  const button = h(
    "button",
    { type: "button", class: "quiet-button", onclick: show },
    worded("Compare with the model solution"),
  );
  place.append(button, note);
  host.bar.element.append(place);
  const close = () => place.remove();
  for (const { input } of parts.flatMap(({ cells }) => cells)) input.addEventListener("input", close, { once: true });
}

/**
 * Return the answers to each part beside the model's.
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
        ? [cellTables(layout, mine.cells, theirs.cells, symbols), cellTables(layout, theirs.cells, mine.cells, symbols)]
        : [plain(own), plain(text)];
      return [
        h("h3", { tabindex: -1 }, ...typesetMessage(visible(title), symbols)),
        h(
          "div",
          { class: "side-by-side" },
          h("section", {}, h("h4", {}, worded("Your answer")), ...boxes[0]),
          h("section", {}, h("h4", {}, worded("Model solution")), ...boxes[1]),
        ),
      ];
    }),
    h("p", { class: "quiet" }, NOTE),
  ];
}

/** @param {unknown} answer */
function plain(answer) {
  if (answer === null) return [h("p", { class: "quiet" }, worded("Nothing."))];
  const text = typeof answer === "string" ? answer : JSON.stringify(answer, null, 1);
  return [h("pre", { tabindex: 0 }, text.split("\n").map(visible).join("\n"))];
}

/**
 * Return one table for each grid; entries that are not those of `others` are marked.
 *
 * @param {Front.Layout} layout
 * @param {string[]} cells
 * @param {string[]} others
 * @param {Set<string>} symbols
 */
function cellTables({ grids }, cells, others, symbols) {
  let next = 0;
  const same = (/** @type {string} */ text) => text.replace(/\s+/gu, "");
  return grids.map(({ rows, columns }) =>
    h(
      "div",
      { class: "choice-table" },
      h(
        "table",
        {},
        h("tr", {}, h("td"), ...columns.map(({ head }) => h("th", { scope: "col" }, visible(head ?? "")))),
        ...rows.map(({ head }) =>
          h(
            "tr",
            {},
            h("th", { scope: "row" }, visible(head ?? "")),
            ...columns.map(() => {
              const [mine, theirs] = [cells[next] ?? "", others[next] ?? ""];
              next += 1;
              return h(
                "td",
                { class: same(mine) === same(theirs) ? null : "changed" },
                ...typesetMessage(visible(mine), symbols),
              );
            }),
          )
        ),
      ),
    )
  );
}
