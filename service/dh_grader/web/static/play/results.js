// The results of a table in free play: the pose of its last frame, and the table in the other convention.

import { decimal, h, visible } from "../shared/dom.js";
import { mathml, matrix } from "../shared/markup.js";
import { worded, wordedFor } from "../shared/words/words.js";

export class Results {
  /** @type {Api.PrintedFormula[][] | undefined} */
  #formulas;
  /** @type {Front.Frame | undefined} */
  #frame;
  /** @type {HTMLElement[]} */
  #entries = [];

  /**
   * `copy` gets the LaTeX of the pose, `use` the rows in the other convention.
   *
   * @param {(latex: string) => void} copy
   * @param {(rows: Api.ConvertedRow[]) => void} use
   */
  constructor(copy, use) {
    /** @type {Api.ConvertedRow[]} */
    this.rows = [];
    const pose = { class: "scroll", tabindex: 0, role: "group" };
    this.freedoms = h("p", { class: "points" });
    this.pose = h("div", { ...pose, "aria-label": worded("Pose as numbers") });
    this.formula = h("div", { ...pose, class: "scroll formula", "aria-label": worded("Pose as formulas") });
    this.converted = h("div", { class: "scroll" });
    this.title = h("h2");
    this.latex = quietButton(worded("Copy LaTeX"), () => copy(this.poseLatex));
    this.use = quietButton(worded("Use this table"), () => use(this.rows));
    this.poseCard = card([h("h2", {}, worded("Pose of the last frame")), this.latex], this.pose, this.formula);
    this.convertedCard = card([this.title, this.use], this.converted);
  }

  /**
   * Show the service's results. If `isKept`, only fade the earlier results, because the table cannot be read now.
   *
   * @param {Api.FramesOfTable} table
   * @param {Api.Convention} convention
   * @param {boolean} isKept
   */
  show({ degrees_of_freedom: freedoms, formulas }, convention, isKept) {
    for (const each of [this.freedoms, this.pose, this.formula, this.converted]) each.classList.toggle("stale", isKept);
    this.use.disabled = this.latex.disabled = isKept;
    if (isKept) return;
    this.freedoms.textContent = freedoms === undefined
      ? ""
      : wordedFor("1 degree of freedom", "{count} degrees of freedom", freedoms);
    const { pose, converted } = formulas ?? {};
    this.#formulas = pose;
    this.formula.hidden = !pose;
    this.formula.replaceChildren(
      pose ? h("div", { class: "bracketed" }, matrix(pose.map((row) => row.map((entry) => entry.mathml)))) : "",
    );
    this.rows = converted ?? [];
    this.convertedCard.hidden = !converted;
    this.converted.replaceChildren(converted ? convertedTable(converted, convention) : "");
  }

  /** @param {Front.Picture} picture */
  showPose({ frames }) {
    this.#frame = frames?.at(-1);
    this.poseCard.hidden = !frames || frames.length < 2;
    if (!this.#frame) return;
    if (!this.#entries.length) {
      const rows = [0, 1, 2, 3].map(() => [0, 1, 2, 3].map(() => h("span", { role: "cell" })));
      const drawn = rows.map((entries) => h("span", { role: "row", class: "row" }, ...entries));
      this.pose.replaceChildren(
        h("div", { class: "bracketed numeric", role: "table", "aria-label": worded("Pose") }, ...drawn),
      );
      this.#entries = rows.flat();
    }
    this.#frame.flat().forEach((value, i) => (this.#entries[i].textContent = decimal(value).replace("-", "−")));
  }

  get poseLatex() {
    const formulas = this.#formulas?.map((row) => row.map((entry) => entry.latex));
    const rows = formulas ?? this.#frame?.map((row) => row.map(decimal)) ?? [];
    return `\\begin{bmatrix}\n${rows.map((row) => row.join(" & ")).join(" \\\\\n")}\n\\end{bmatrix}`;
  }
}

/**
 * Return a section with a header.
 *
 * @param {Node[]} head
 * @param {...Node} children
 */
export function card(head, ...children) {
  return h("section", { class: "card part" }, h("header", {}, ...head), ...children);
}

/** @param {string} text @param {() => void} act */
export function quietButton(text, act) {
  return h("button", { type: "button", class: "quiet-button", onclick: act }, text);
}

/** @param {Api.ConvertedRow[]} rows @param {Api.Convention} convention */
function convertedTable(rows, convention) {
  const index = convention === "standard" ? "i−1" : "i";
  const heads = [["a", index], ["α", index], ["d", "i"], ["θ", "i"]].map(([letter, sub]) =>
    h("th", { scope: "col" }, h("i", {}, letter), h("sub", {}, sub))
  );
  const body = rows.map(({ label, cells }) => {
    const shown = cells.map((cell) => h("td", { class: "said" }, mathml(cell.mathml) ?? visible(cell.text)));
    return h("tr", {}, h("th", { scope: "row" }, label), ...shown);
  });
  const caption = h("caption", { class: "aloud" }, worded("The table in the other convention"));
  return h(
    "table",
    {},
    caption,
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, h("span", { class: "aloud" }, worded("row"))), ...heads)),
    h("tbody", {}, ...body),
  );
}
