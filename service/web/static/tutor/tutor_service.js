// What a tutor's pages ask the service for.

const HOME = new URL("../", import.meta.url);
// So often a request is sent again that the service had no room for, and after at most so many seconds.
const TRIES = 5;
const LONGEST_PAUSE = 10;

/**
 * An address below that of the service.
 *
 * @param {string} path
 */
export const address = (path) => new URL(path, HOME).href;

/**
 * The answer to a body; throws an Error with the reason where it is refused.
 *
 * @param {string} path
 * @param {BodyInit} body
 * @param {string} [type]
 */
export function post(path, body, type = "application/json") {
  return asked(path, { method: "POST", headers: { "Content-Type": type }, body });
}

/**
 * The JSON that the service has at a path below its address.
 *
 * @param {string} path
 * @returns {Promise<any>}
 */
export async function get(path) {
  return (await asked(address(path), {})).json();
}

/**
 * The JSON that the service answers to a JSON body, at a path below its address.
 *
 * @param {string} path
 * @param {unknown} body
 * @returns {Promise<any>}
 */
export async function send(path, body) {
  return (await post(address(path), JSON.stringify(body))).json();
}

/**
 * The same; where the service has no room for it now, it is sent again.
 *
 * @param {string} path
 * @param {unknown} body
 * @returns {Promise<any>}
 */
export async function sendPatiently(path, body) {
  for (let left = TRIES;; left -= 1) {
    try {
      return await send(path, body);
    } catch (error) {
      if (!error.pause || left === 0) throw error;
      await pause(Math.min(error.pause, LONGEST_PAUSE));
    }
  }
}

/** @param {number} seconds @returns {Promise<void>} */
export const pause = (seconds) => new Promise((done) => setTimeout(done, 1000 * seconds));

/** The service refused a request; `pause` says after how many seconds it may be sent again, or 0. */
class Refusal extends Error {
  /** @param {string} reason @param {number} pause */
  constructor(reason, pause) {
    super(reason);
    this.pause = pause;
    this.kind = pause ? "busy" : "refused";
  }
}

/** @param {string} path @param {RequestInit} options */
async function asked(path, options) {
  const answer = await fetch(path, options);
  if (answer.ok) return answer;
  /** @type {Partial<Api.Problem> | null} */
  const problem = await answer.json().catch(() => null);
  const reason = problem?.detail ?? `The service answered with the status ${answer.status}.`;
  const wait = Number(answer.headers.get("Retry-After"));
  throw new Refusal(reason, wait);
}

/**
 * The words for a request that failed.
 *
 * @param {unknown} error
 */
export function refusal(error) {
  return error instanceof Refusal ? error.message : "The service cannot be reached.";
}
