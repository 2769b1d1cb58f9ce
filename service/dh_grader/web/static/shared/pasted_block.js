// A block of cells from a spreadsheet that is smaller than the table. It fills the cells from the cursor on.

// A text with one of these may be a table of another program, which the service reads.
const OF_A_TABLE = /[&|[\]{}]|\\\\/;

/**
 * Return the rows of cells of a text that was copied from a spreadsheet, or null if it is not a block of at least two
 * cells.
 *
 * @param {string} text
 */
export function blockOf(text) {
  const rows = text.replace(/\r\n?/g, "\n").replace(/\n$/, "").split("\n").map((row) => row.split("\t").map(unquoted));
  const isBlock = rows.every((row) => row.length === rows[0].length) && rows.length * rows[0].length > 1;
  // A single column with separators may be a table with a row in each line.
  const isTable = OF_A_TABLE.test(text) || (rows[0].length === 1 && /[ ,;]/.test(text.trim()));
  return isBlock && !isTable ? rows : null;
}

/**
 * Return the text of a cell. If a cell contains quotes, spreadsheets double these quotes and put the text into quotes.
 *
 * @param {string} text
 */
function unquoted(text) {
  const [, inner] = text.match(/^"((?:[^"]|"")*)"$/) ?? [null, text];
  return inner.replaceAll('""', '"').trim();
}

/**
 * Return the cells of `rows` that a block fills from `cell` on, with their texts, or null if it does not fit.
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
 * Return a cell and its text as a pair; the type checker would infer a list.
 *
 * @template Cell
 * @param {Cell} cell
 * @param {string} text
 * @returns {[Cell, string]}
 */
export const pair = (cell, text) => [cell, text];
