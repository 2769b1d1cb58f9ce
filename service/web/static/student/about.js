// The task of an exercise: title and source, statement with the robot, and symbols.

import { h, visible } from "../shared/dom.js";
import { html } from "../shared/markup.js";
import { symbolName, typeset } from "../typeset/names.js";

/**
 * Return the section with the task. Beside the cells, it scrolls separately, also by keyboard.
 *
 * @param {Api.Exercise} exercise
 * @param {"h1" | "h2"} level of the title
 * @param {Front.RobotFigure | null} robot
 */
export function about({ title, source, statement, statement_html: markup, symbols }, level, robot) {
  const names = new Set(symbols.map((symbol) => symbol.name));
  const maths = (/** @type {string} */ each) => typeset(visible(each), names);
  const header = h(
    "header",
    {},
    h(level, { id: "title" }, ...typeset(visible(title))),
    h("p", { class: "quiet" }, ...typeset(visible(source))),
  );
  const text = markup ? html(markup) : statement.trim().split(/\n\n+/).map((each) => h("p", {}, ...maths(each)));
  const terms = symbols.flatMap(({ name, unit, description }) => [
    h("dt", {}, symbolName(name), " ", h("code", {}, visible(name))),
    h("dd", {}, ...maths(unit ? `${description} (${unit})` : description)),
  ]);
  const head = h(level === "h1" ? "h2" : "h3", {}, "Symbols");
  return h(
    "section",
    { class: "about", tabindex: 0, "aria-labelledby": "title" },
    header,
    // The button comes before the view that it opens, so that it stays visible and Tab leads into the view.
    h("div", { class: "statement" }, robot?.button, robot?.figure, ...text),
    terms.length ? h("section", { class: "symbols" }, head, h("dl", {}, ...terms)) : null,
  );
}
