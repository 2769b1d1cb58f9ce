// Requests of the tutor's pages to the service.

import { language, worded } from "../shared/words/words.js";

const HOME = new URL("../", import.meta.url);
// How often a request is repeated if the service is busy, and the longest pause between two tries in seconds.
const TRIES = 5;
const LONGEST_PAUSE = 10;

/**
 * Return the address of a path of the service.
 *
 * @param {string} path
 */
export const address = (path) => new URL(path, HOME).href;

/**
 * Post a body and return the response. Throws an Error with the reason if the service refuses the request.
 *
 * @param {string} path
 * @param {BodyInit} body
 * @param {string} [type]
 */
export function post(path, body, type = "application/json") {
  return asked(path, { method: "POST", headers: { "Content-Type": type }, body });
}

/**
 * Get the JSON at a path of the service.
 *
 * @param {string} path
 * @returns {Promise<any>}
 */
export async function get(path) {
  return (await asked(address(path), {})).json();
}

/**
 * Post a JSON body to a path of the service and return the JSON of the response.
 *
 * @param {string} path
 * @param {unknown} body
 * @returns {Promise<any>}
 */
export async function send(path, body) {
  return (await post(address(path), JSON.stringify(body))).json();
}

/**
 * Post a JSON body as `send` does, and repeat the request while the service is busy.
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

/** The service refused a request. `pause` is the number of seconds until another try, or 0. */
class Refusal extends Error {
  /** @param {string} reason @param {number} pause @param {number} status */
  constructor(reason, pause, status) {
    super(reason);
    this.pause = pause;
    this.kind = pause ? "busy" : status >= 500 ? "failed" : "refused";
  }
}

/** @param {string} path @param {RequestInit} options */
async function asked(path, options) {
  const headers = new Headers(options.headers);
  headers.set("Accept-Language", language);
  const answer = await fetch(path, { ...options, headers });
  if (answer.ok) return answer;
  /** @type {Partial<Api.Problem> | null} */
  const problem = await answer.json().catch(() => null);
  const reason = problem?.detail ?? worded("The service answered with the status {status}.", { status: answer.status });
  const wait = Number(answer.headers.get("Retry-After"));
  throw new Refusal(reason, wait, answer.status);
}

/**
 * Return the message for a failed request.
 *
 * @param {unknown} error
 */
export function refusal(error) {
  return error instanceof Refusal ? error.message : worded("The service cannot be reached.");
}
