// A block of cells from a spreadsheet, smaller than the table: it goes where the cursor is.

// What another program would mean by several values: a table for the service to read.
const OF_A_TABLE = /[&|[\]{}]|\\\\/;

/**
 * The cells of a text as spreadsheets copy them, row by row; null where it is no block of two cells or more.
 *
 * @param {string} text
 */
export function blockOf(text) {
  const rows = text.replace(/\r\n?/g, "\n").replace(/\n$/, "").split("\n").map((row) => row.split("\t").map(unquoted));
  const isBlock = rows.every((row) => row.length === rows[0].length) && rows.length * rows[0].length > 1;
  // One column is also how a table looks whose values stand side by side.
  const isTable = OF_A_TABLE.test(text) || (rows[0].length === 1 && /[ ,;]/.test(text.trim()));
  return isBlock && !isTable ? rows : null;
}

/**
 * A cell that holds quotes is copied in quotes, with its own doubled.
 *
 * @param {string} text
 */
function unquoted(text) {
  const [, inner] = text.match(/^"((?:[^"]|"")*)"$/) ?? [null, text];
  return inner.replaceAll('""', '"').trim();
}

/**
 * The cells that a block fills from `cell` on in `rows` (lists of cells), with their texts; null where it does not fit.
 *
 * @template Cell
 * @param {Cell} cell
 * @param {Cell[][]} rows
 * @param {string[][]} block
 * @returns {[Cell, string][] | null}
 */
export function placedFrom(cell, rows, block) {
  const first = rows.findIndex((row) => row.includes(cell));
  const column = rows[first].indexOf(cell);
  const fits = block.every((row, i) => column + row.length <= (rows[first + i]?.length ?? 0));
  if (!fits) return null;
  return block.flatMap((row, i) => row.map((text, j) => pair(rows[first + i][column + j], text)));
}

/**
 * Return a cell and its text, as two values and not as a list of either.
 *
 * @template Cell
 * @param {Cell} cell
 * @param {string} text
 * @returns {[Cell, string]}
 */
export const pair = (cell, text) => [cell, text];
