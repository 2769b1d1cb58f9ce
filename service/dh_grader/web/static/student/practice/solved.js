// The generated robots that earned full marks, kept in the browser. A browser without storage is no error.

const PREFIX = "dh-grader:practice";
const MOST = 1000;

/**
 * Return the ids of the solved robots of a level.
 *
 * @param {string} base the address of the service
 * @param {number} level
 * @returns {string[]}
 */
export function solvedOf(base, level) {
  try {
    const kept = JSON.parse(localStorage.getItem(nameOf(base, level)) ?? "[]");
    return Array.isArray(kept) ? kept.filter((id) => typeof id === "string") : [];
  } catch {
    return [];
  }
}

/**
 * Keep the id of a solved robot; the oldest ids of many are forgotten.
 *
 * @param {string} base
 * @param {number} level
 * @param {string} id
 */
export function keepSolved(base, level, id) {
  const before = solvedOf(base, level);
  if (before.includes(id)) return;
  try {
    localStorage.setItem(nameOf(base, level), JSON.stringify([...before, id].slice(-MOST)));
  } catch {
    // The robot is not shown as solved, but its report is shown.
  }
}

/** @param {string} base @param {number} level */
const nameOf = (base, level) => `${PREFIX}:${base}:${level}`;
