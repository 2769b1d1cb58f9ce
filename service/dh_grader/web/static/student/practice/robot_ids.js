// The ids of generated robots, such as practice-2-modified~k3f9.

const ID = /^practice-([1-4])-(standard|modified)~[0-9a-z]{1,8}$/;

/**
 * Return the level and the convention in a robot's id, or null for another id.
 *
 * @param {string | null} id
 * @returns {{ level: number, convention: Api.Convention } | null}
 */
export function robotOf(id) {
  const found = ID.exec(id ?? "");
  return found && { level: Number(found[1]), convention: /** @type {Api.Convention} */ (found[2]) };
}

/**
 * Return the id of the same robot in another convention.
 *
 * @param {string} id
 * @param {string} convention
 */
export function inConvention(id, convention) {
  return id.replace(/-(standard|modified)~/, `-${convention}~`);
}

// The situation of a robot that a slip in a column concerns.
/** @type {Record<string, Api.Situation>} */
const SITUATIONS = { a: "offset", d: "offset", theta: "turned" };

/**
 * Return the situation of the first slip in a report, which the next robot should have; null without a slip.
 *
 * @param {Pick<Api.Report, "parts">} report
 * @param {number[]} sliding the joints that slide
 * @returns {Api.Situation | null}
 */
export function slipIn({ parts }, sliding) {
  for (const row of parts.flatMap((part) => part.rows)) {
    const wrong = row.cells.find(({ verdict }) => verdict === "incorrect");
    if (!wrong) continue;
    if (sliding.includes(Number(row.label))) return "sliding";
    return SITUATIONS[wrong.label] ?? "parallel";
  }
  return null;
}
