// The task of an exercise: title, statement with the robot, and symbols.

import { h, visible } from "../shared/dom.js";
import { html } from "../shared/markup.js";
import { symbolName, typeset } from "../typeset/names.js";
import { conventionName, mostInWords } from "../shared/words/phrases.js";
import { placed, worded } from "../shared/words/words.js";

/**
 * Return the badges below the title: the convention, the points of the shown parts, and the minutes if all are shown.
 *
 * @param {Api.Exercise} exercise
 * @param {Api.Part[]} shown
 */
function badges({ conventions, minutes, parts }, shown) {
  const worth = shown.reduce((sum, part) => sum + part.points, 0);
  const texts = [
    ...(conventions ?? []).map(conventionName),
    mostInWords(worth),
  ];
  if (minutes && shown.length === parts.length) texts.push(worded("{minutes} min", { minutes }));
  return h("p", { class: "tags" }, ...texts.map((text) => h("span", { class: "badge" }, text)));
}

/**
 * Return the section with the task. It is beside the cells, and scrolls separately, also by keyboard.
 *
 * @param {Api.Exercise} exercise
 * @param {Api.Part[]} shown the parts that the element shows
 * @param {"h1" | "h2"} level of the title
 * @param {Front.RobotFigure | null} robot
 */
export function about(exercise, shown, level, robot) {
  const { title, summary, statement, statement_html: markup, symbols } = exercise;
  const names = new Set(symbols.map((symbol) => symbol.name));
  const maths = (/** @type {string} */ each) => typeset(visible(each), names);
  const header = h(
    "header",
    {},
    h(level, { id: "title", part: "title" }, ...typeset(visible(title))),
    summary ? h("p", { class: "quiet" }, ...maths(summary)) : null,
    badges(exercise, shown),
  );
  const text = markup ? html(markup) : statement.trim().split(/\n\n+/).map((each) => h("p", {}, ...maths(each)));
  const terms = symbols.flatMap(({ name, unit, description }) => [
    h("dt", {}, symbolName(name), " ", h("code", {}, visible(name))),
    h("dd", {}, ...maths(unit ? `${description} (${unit})` : description)),
  ]);
  const head = h(level === "h1" ? "h2" : "h3", {}, worded("Symbols"));
  return h(
    "section",
    { class: "about", part: "about", tabindex: 0, "aria-labelledby": "title" },
    header,
    // The button comes before the view that it opens, so that it stays visible and Tab leads into the view.
    h("div", { class: "statement", part: "statement" }, robot?.button, robot?.told, robot?.figure, ...text),
    terms.length ? h("section", { class: "symbols", part: "symbols" }, head, h("dl", {}, ...terms)) : null,
  );
}

/** Return the line with the source of an exercise. @param {Api.Exercise} exercise */
export function source(exercise) {
  const told = placed(worded("Source: {source}"), { source: typeset(visible(exercise.source)) });
  return h("p", { class: "quiet source", part: "source" }, ...told);
}
