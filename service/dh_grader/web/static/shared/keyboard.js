// The keyboard of a spreadsheet: arrows, Enter and Shift+Enter move between cells.

/**
 * Return the cell that a key leads to from `cell` in `rows`, or null if the key does not leave the cell.
 *
 * @template {{ input: HTMLInputElement }} Cell
 * @param {KeyboardEvent} event
 * @param {Cell} cell
 * @param {Cell[][]} rows
 * @returns {Cell | null}
 */
export function target(event, cell, rows) {
  if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return null;
  const row = rows.findIndex((cells) => cells.includes(cell));
  const column = rows[row].indexOf(cell);
  const { selectionStart: from, selectionEnd: to, value } = cell.input;
  const isWhole = from === 0 && to === value.length;
  /** @type {(step: number) => Cell | null} */
  const vertical = (step) => rows[row + step]?.[Math.min(column, rows[row + step].length - 1)] ?? null;
  switch (event.key) {
    case "ArrowUp":
      return event.shiftKey ? null : vertical(-1);
    case "ArrowDown":
      return event.shiftKey ? null : vertical(1);
    case "Enter":
      return vertical(event.shiftKey ? -1 : 1);
    case "ArrowLeft":
      return !event.shiftKey && (isWhole || to === 0) ? (rows[row][column - 1] ?? null) : null;
    case "ArrowRight":
      return !event.shiftKey && (isWhole || from === value.length) ? (rows[row][column + 1] ?? null) : null;
    default:
      return null;
  }
}

/**
 * Return "undo" or "redo" if the pressed keys mean it, or else null.
 *
 * @param {KeyboardEvent} event
 * @returns {Front.Direction | null}
 */
export function undoKey(event) {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return null;
  const key = event.key.toLowerCase();
  if (key === "z") return event.shiftKey ? "redo" : "undo";
  return key === "y" && !event.shiftKey ? "redo" : null;
}
