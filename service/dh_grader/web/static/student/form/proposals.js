// Proposals of the form for a finding of the report: read angles in the other unit, or reorder columns.

import { h } from "../../shared/dom.js";
import { LETTERS } from "../kinds.js";
import { worded } from "../../shared/words/words.js";

/** @type {Record<string, Api.AngleUnit>} */
const UNITS = { degrees_as_radians: "degrees", radians_as_degrees: "radians" };
const PERMUTED = "columns_permuted";
// A list of four parameters, such as "θ, d, a, α".
const ORDER = /[aαdθ](?:, [aαdθ]){3}/g;
// A number that no formula in radians has: 7 or more, and without π.
const DEGREES = /(?:^|[^\w.^])(?:[7-9]|\d{2,})(?![\d.]*\s*(?:°|deg))/;

/**
 * Return the angle unit in which a finding proposes to read all angles, or null. Texts with a conversion between
 * units need another repair.
 *
 * @param {string} code
 * @param {string[]} texts of the cells of the finding
 * @param {Api.AngleUnit} unit in which they were read
 * @returns {Api.AngleUnit | null}
 */
export function proposedUnit(code, texts, unit) {
  const proposed = Object.hasOwn(UNITS, code) ? UNITS[code] : null;
  if (!proposed || proposed === unit) return null;
  const inDegrees = texts.filter((text) => !/pi|π/i.test(text) && DEGREES.test(text));
  return (proposed === "degrees") === inDegrees.length > 0 ? proposed : null;
}

/**
 * Return the student's order of columns according to a finding, or null. The finding's message names this order first.
 *
 * @param {string} code
 * @param {string} message
 * @param {string[]} columns of the table
 */
export function writtenOrder(code, message, columns) {
  if (code !== PERMUTED) return null;
  const labels = new Map(Object.entries(LETTERS).map(([label, letter]) => [letter, label]));
  const [first = ""] = message.match(ORDER) ?? [];
  const order = first.split(", ").map((letter) => labels.get(letter) ?? "");
  const isOrder = columns.length === order.length && columns.every((column) => order.includes(column));
  return isOrder ? order : null;
}

/**
 * Return the texts of a row, each moved to its correct column.
 *
 * @param {string[]} texts
 * @param {string[]} order in which they are written
 * @param {string[]} columns
 */
export function reordered(texts, order, columns) {
  return columns.map((column) => texts[order.indexOf(column)]);
}

/**
 * Return a button that does what a message proposes and checks again, or null.
 *
 * @param {Front.PartView} view
 * @param {Api.Feedback} feedback
 * @param {Front.PartCell[]} cells of the message; none if the message is about the whole part
 */
export function proposal(view, { code, message }, cells) {
  const { host, part: { shape } } = view;
  const { form } = host;
  if (!form) return null;
  const texts = (cells.length ? cells : view.cells).map((cell) => cell.text);
  const unit = proposedUnit(code, texts, form.angleUnit);
  if (unit) {
    return button(
      unit === "degrees" ? worded("Read angles as degrees") : worded("Read angles as radians"),
      () => form.useUnit(unit),
    );
  }
  const columns = shape.form === "dh_table" ? shape.columns : [];
  const order = writtenOrder(code, message, columns);
  if (!order) return null;
  return button(worded("Reorder columns"), () => {
    const right = view.rows.flatMap(({ cells }) => reordered(cells.map(({ text }) => text), order, columns));
    view.write(view.cells.map((cell, i) => [cell, right[i]]));
    host.check();
  });
}

/** @param {string} text @param {() => void} onclick */
const button = (text, onclick) => h("button", { type: "button", class: "quiet-button", onclick }, text);
