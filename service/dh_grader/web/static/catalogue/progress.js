// The best points of each part, kept in the browser; the catalogue shows them. A browser without storage is no error.

const PREFIX = "dh-grader:progress";

/**
 * Return the best points by part id; an empty object if there are none.
 *
 * @param {string} base the address of the service
 * @param {string} exercise
 * @returns {Record<string, number>}
 */
export function progressOf(base, exercise) {
  try {
    const kept = JSON.parse(localStorage.getItem(nameOf(base, exercise)) ?? "{}");
    return Object.fromEntries(Object.entries(kept).filter(([, points]) => typeof points === "number" && points > 0));
  } catch {
    return {};
  }
}

/**
 * Store the points of graded parts that have improved; forget parts that the exercise no longer has.
 *
 * @param {string} base
 * @param {Pick<Api.Exercise, "id" | "parts">} exercise
 * @param {Pick<Api.PartReport, "part" | "points">[]} graded
 */
export function keepProgress(base, { id, parts }, graded) {
  const before = progressOf(base, id);
  const now = new Map(graded.map(({ part, points }) => [part, points]));
  const best = parts.map((part) => [part.id, Math.max(before[part.id] ?? 0, now.get(part.id) ?? 0)]);
  try {
    localStorage.setItem(nameOf(base, id), JSON.stringify(Object.fromEntries(best)));
  } catch {
    // The catalogue does not show this progress, but the report does.
  }
}

/** @param {string} base @param {string} exercise */
const nameOf = (base, exercise) => `${PREFIX}:${base}:${exercise}`;
