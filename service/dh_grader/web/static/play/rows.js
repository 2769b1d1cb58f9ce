// The rows of a table in free play: cells, and the kind of joint: revolute (R), prismatic (P) or none (F).

export const MOST_ROWS = 12;
export const MOST_JOINTS = 10;

const D = 2;
const THETA = 3;

/**
 * Return the cells of a new row of joint `number`.
 *
 * @param {string} kind
 * @param {number | null} number
 */
export function freshCells(kind, number) {
  return ["0", "0", kind === "P" ? `d${number}` : "0", kind === "R" ? `theta${number}` : "0"];
}

/**
 * Return the number of the joint of each row, or null for a row without one.
 *
 * @param {Front.PlayRow[]} rows
 */
export function jointNumbers(rows) {
  let count = 0;
  return rows.map(({ kind }) => (kind === "F" ? null : ++count));
}

/**
 * Return how many rows have a joint.
 *
 * @param {Front.PlayRow[]} rows
 */
export const jointCount = (rows) => rows.filter(({ kind }) => kind !== "F").length;

/**
 * Return rows from the cells of a pasted table; a joint slides if only d holds its variable.
 *
 * @param {string[][]} cells
 * @returns {Front.PlayRow[]}
 */
export function rowsOf(cells) {
  let joints = 0;
  return cells.map(([a, alpha, d, theta]) => {
    const number = joints + 1;
    /** @type {(text: string) => boolean} */
    const own = (text) => new RegExp(`\\b(theta|q|d)_?${number}\\b`).test(text);
    const slides = own(d) && !new RegExp(`\\b(theta|q)_?${number}\\b`).test(theta);
    const kind = slides ? "P" : own(theta) ? "R" : "F";
    if (kind !== "F") joints = number;
    // The service has read all joints as revolute.
    const named = slides ? d.replace(new RegExp(`\\btheta${number}\\b`), `d${number}`) : d;
    return { kind, cells: [a, alpha, named, theta] };
  });
}

/**
 * Return the rows after row `i` got a joint of another kind. The joint variable moves to the column of this kind.
 *
 * @param {Front.PlayRow[]} rows
 * @param {number} i
 * @param {string} kind
 */
export function withKind(rows, i, kind) {
  const before = jointNumbers(rows)[i];
  const number = jointNumbers(rows.with(i, { ...rows[i], kind }))[i];
  const [a, alpha, d, theta] = rows[i].cells;
  const fresh = freshCells(kind, number);
  /** @type {(text: string) => boolean} */
  const isBare = (text) => ["0", "", `d${before}`, `theta${before}`, `q${before}`].includes(text.trim());
  const cells = [a, alpha, isBare(d) ? fresh[D] : d, isBare(theta) ? fresh[THETA] : theta];
  return renumbered(jointNumbers(rows), rows.with(i, { kind, cells }));
}

/**
 * Return the rows without row `i`.
 *
 * @param {Front.PlayRow[]} rows
 * @param {number} i
 */
export function without(rows, i) {
  return renumbered(jointNumbers(rows).toSpliced(i, 1), rows.toSpliced(i, 1));
}

/**
 * Return the rows after a change. A cell that holds only its joint variable gets the new number of the joint.
 *
 * @param {(number | null)[]} old the joint of each row before
 * @param {Front.PlayRow[]} rows
 */
function renumbered(old, rows) {
  const numbers = jointNumbers(rows);
  return rows.map(({ kind, cells }, i) => {
    const number = numbers[i];
    if (!old[i] || !number || old[i] === number) return { kind, cells };
    const variable = new RegExp(`^(theta|d|q)_?${old[i]}$`);
    return { kind, cells: cells.map((text) => text.replace(variable, `$1${number}`)) };
  });
}

/**
 * Return a robot of the right shape from a value that was stored or linked, or null.
 *
 * @param {any} value
 * @returns {Front.Robot | null}
 */
export function robotOf(value) {
  const { convention, unit, rows } = value ?? {};
  if (!Array.isArray(rows) || !rows.length || rows.length > MOST_ROWS) return null;
  if (!rows.every(isRow) || jointCount(rows) > MOST_JOINTS) return null;
  return {
    convention: convention === "modified" ? "modified" : "standard",
    unit: unit === "degrees" ? "degrees" : "radians",
    rows: rows.map(({ kind, cells }) => ({ kind, cells })),
  };
}

/** @param {any} row */
function isRow(row) {
  const { kind, cells } = row ?? {};
  return ["R", "P", "F"].includes(kind) && Array.isArray(cells) && cells.length === 4 &&
    cells.every((cell) => typeof cell === "string");
}
