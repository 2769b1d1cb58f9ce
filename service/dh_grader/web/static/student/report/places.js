// The places of a message in words.

import { worded, wordedFor } from "../../shared/words/words.js";

/** @type {Record<string, string>} */
const NAMES = { alpha: "α", theta: "θ" };
// The label of a row of a matrix in a list of matrices, such as A2.1.
const OF_MATRIX = /^(?<matrix>.+)\.(?<row>\d+)$/;

/**
 * Return places in words, such as "row 1 d, θ; rows 2, 3", "A2 rows 1, 3 columns 1, 2" or "A3". If the places include
 * all cells of a row, only the row is named; if they include all rows of a matrix (or all but one), only the matrix.
 *
 * @param {Api.Place[]} places
 * @param {Api.RowReport[]} [rows] of the part
 */
export function placesInWords(places, rows = []) {
  const sizes = new Map(rows.map(({ label, cells }) => [label, cells.length]));
  /** @type {Map<string, string[]>} */
  const named = new Map();
  for (const { row, cell } of places) {
    named.set(row, [...(named.get(row) ?? []), ...(cell === undefined ? [] : [cell])]);
  }
  /** @type {Map<string, string[]>} */
  const alike = new Map();
  for (const [label, cells] of named) {
    const { matrix = "" } = OF_MATRIX.exec(label)?.groups ?? {};
    const key = JSON.stringify([matrix, cells.length > 1 && cells.length === sizes.get(label) ? [] : cells]);
    alike.set(key, [...(alike.get(key) ?? []), label]);
  }
  return [...alike].map(([key, labels]) => inWords(JSON.parse(key), labels, sizes)).join("; ");
}

/** @param {[string, string[]]} place @param {string[]} labels @param {Map<string, number>} sizes */
function inWords([matrix, cells], labels, sizes) {
  if (!matrix) return rowsInWords(labels, cells);
  if (!cells.length && isWhole(matrix, labels, [...sizes.keys()])) return matrix;
  const rows = rowsInWords(labels.map((label) => label.slice(matrix.length + 1)), cells);
  return worded("{matrix} {rows}", { matrix, rows });
}

/** @param {string} matrix @param {string[]} labels @param {string[]} all */
function isWhole(matrix, labels, all) {
  return labels.length > 1 && labels.length >= all.filter((label) => matrixOf(label) === matrix).length - 1;
}

/** @param {string[]} labels @param {string[]} cells */
function rowsInWords(labels, cells) {
  const values = { rows: labels.join(", "), cells: cells.length ? cellsInWords(cells) : "" };
  return cells.length
    ? wordedFor("row {rows} {cells}", "rows {rows} {cells}", labels.length, values)
    : wordedFor("row {rows}", "rows {rows}", labels.length, values);
}

/**
 * Return the cells of a row with these labels in words, such as "a, α" or "columns 1, 2".
 *
 * @param {string[]} labels
 */
export function cellsInWords(labels) {
  const columns = labels.map((label) => NAMES[label] ?? label).join(", ");
  if (!/^\d+$/.test(labels[0])) return columns;
  return wordedFor("column {columns}", "columns {columns}", labels.length, { columns });
}

/**
 * Return the matrix that a row belongs to; null for a row of a table or of a single matrix.
 *
 * @param {string} label
 */
export function matrixOf(label) {
  return OF_MATRIX.exec(label)?.groups?.matrix ?? null;
}
