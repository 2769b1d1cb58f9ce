// The situations in which the student made slips in practice. The browser keeps each one until it was right twice.

const NAME = "dh-grader:practice-slips";
const TIMES = 2;
const SITUATIONS = /** @type {const} */ (["offset", "sliding", "parallel", "turned"]);

/** How often each situation must still be right, and the situation for which a robot was chosen, by the robot's id. */
/** @typedef {{ left: Partial<Record<Api.Situation, number>>, dealt: Record<string, Api.Situation> }} Kept */

/** @param {string} base the address of the service @returns {Kept} */
function load(base) {
  try {
    const { left = {}, dealt = {} } = JSON.parse(localStorage.getItem(`${NAME}:${base}`) ?? "{}");
    const known = SITUATIONS.filter((each) => Number.isInteger(left[each]) && left[each] > 0 && left[each] <= TIMES);
    return { left: Object.fromEntries(known.map((each) => [each, left[each]])), dealt };
  } catch {
    return { left: {}, dealt: {} };
  }
}

/** @param {string} base @param {Kept} kept */
function save(base, kept) {
  try {
    localStorage.setItem(`${NAME}:${base}`, JSON.stringify(kept));
  } catch {
    // Without storage, the next robot favours nothing.
  }
}

/**
 * Return the situation that the next robot should have: the one that must still be right most often; null without any.
 *
 * @param {string} base
 * @returns {Api.Situation | null}
 */
export function favoured(base) {
  const { left } = load(base);
  const [first] = SITUATIONS.filter((each) => left[each]).toSorted((one, other) =>
    (left[other] ?? 0) - (left[one] ?? 0)
  );
  return first ?? null;
}

/** Store the situation for which a robot was chosen. @param {string} base @param {string} id @param {Api.Situation | null} situation */
export function noteDealt(base, id, situation) {
  save(base, { ...load(base), dealt: situation ? { [id]: situation } : {} });
}

/**
 * Store the situation of a slip. Without a slip, the situation for which the robot was chosen was right once.
 *
 * @param {string} base
 * @param {string} id
 * @param {Api.Situation | null} slip
 */
export function noteGraded(base, id, slip) {
  const { left, dealt } = load(base);
  if (slip) return save(base, { left: { ...left, [slip]: TIMES }, dealt });
  const right = dealt[id];
  if (!right) return undefined;
  // Each robot counts once.
  return save(base, { left: { ...left, [right]: (left[right] ?? 1) - 1 }, dealt: {} });
}
