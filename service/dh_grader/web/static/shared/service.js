// Requests to the service. Each failure is a ServiceError with a message for the student.

import { language, worded } from "./words/words.js";

// Milliseconds until a request fails; longer than any grading.
const PATIENCE = 20_000;
// Students have no API key, but their course's site has one.
const KEY_NEEDED = worded("Please open this exercise from your course page.");

/** A request that failed. `kind` is "offline", "busy", "refused" or "failed". */
export class ServiceError extends Error {
  /** @param {"offline" | "busy" | "refused" | "failed"} kind @param {string} text @param {number} [status] */
  constructor(kind, text, status = 0) {
    super(text);
    this.kind = kind;
    this.status = status;
  }
}

/**
 * Return null if the service refused the request, for example because the exercise no longer exists. Throw any other
 * error, because another try may succeed.
 *
 * @param {Error & { kind?: string }} error
 */
export function nullIfRefused(error) {
  if (error.kind === "refused") return null;
  throw error;
}

export class Service {
  /**
   * `base` is the address of the service, with a slash at its end. `token` returns the learner's token, or null.
   * If `assignment` returns "course/assignment", exercises are the learner's variants in this assignment.
   *
   * @param {string} base
   * @param {() => string | null} [token]
   * @param {() => string | null} [assignment]
   */
  constructor(base, token = () => null, assignment = () => null) {
    this.base = base;
    this.token = token;
    this.assignment = assignment;
  }

  /** Return a copy of this service for the exercises of an assignment. @param {string} path "course/assignment" */
  within(path) {
    return new Service(this.base, this.token, () => path);
  }

  /** True if exercises are a learner's variants in an assignment. */
  get isAssigned() {
    return Boolean(this.token() && this.assignment());
  }

  /** @param {string} path */
  address(path) {
    return new URL(path, this.base).href;
  }

  /** @param {string} id @returns {Promise<Api.Exercise>} */
  exercise(id) {
    return this.#ask(this.#own(`v1/exercises/${encodeURIComponent(id)}`), undefined, { own: this.isAssigned });
  }

  /** @param {Api.PreviewRequest} body @returns {Promise<Api.Preview>} */
  preview(body) {
    return this.#ask(this.#own("v1/preview"), body);
  }

  /** @param {Api.PreviewManyRequest} body @returns {Promise<Api.PreviewManyResponse>} */
  previews(body) {
    return this.#ask(this.#own("v1/previews"), body);
  }

  /** @param {string} id @param {Api.GradeRequest} body @returns {Promise<Api.Report>} */
  grade(id, body) {
    return this.#ask(this.#own(`v1/exercises/${encodeURIComponent(id)}/grade`), body);
  }

  /** @param {string} id @param {Api.HintRequest} body @returns {Promise<Api.Hint>} */
  hint(id, body) {
    return this.#ask(this.#own(`v1/exercises/${encodeURIComponent(id)}/hints`), body);
  }

  /** @param {string} attempt @param {Api.AttemptHintRequest} body @returns {Promise<Api.Hint>} */
  takeHint(attempt, body) {
    return this.#ask(`v1/attempts/${encodeURIComponent(attempt)}/hints`, body);
  }

  /** The model solution, for answers with full marks. @param {string} id @param {Api.GradeRequest} body @returns {Promise<Api.ModelSolution>} */
  solution(id, body) {
    return this.#ask(this.#own(`v1/exercises/${encodeURIComponent(id)}/solution`), body);
  }

  /** @param {string} id @param {Api.ChoicesRequest} body @returns {Promise<Api.FrameChoices>} */
  choices(id, body) {
    return this.#ask(this.#own(`v1/exercises/${encodeURIComponent(id)}/choices`), body);
  }

  /** @param {Api.FramesRequest} body @returns {Promise<Api.Frames>} */
  frames(body) {
    return this.#ask(this.#own("v1/frames"), body);
  }

  /** Load a drawing with the token; return its blob URL, which must be revoked after use. @param {string} address */
  async picture(address) {
    const headers = { Authorization: `Bearer ${this.token()}`, "Accept-Language": language };
    /** @type {RequestInit} */
    const options = { credentials: "omit", headers, signal: AbortSignal.timeout(PATIENCE) };
    const answer = await fetch(this.#own(address), options);
    if (!answer.ok) throw failure(answer.status, {});
    // The policy of our pages allows pictures with blob URLs, but none with data URLs.
    return URL.createObjectURL(await answer.blob());
  }

  /** Return the path with the assignment, if there is one. @param {string} path */
  #own(path) {
    if (!this.isAssigned) return path;
    const [course = "", assignment = ""] = (this.assignment() ?? "").split("/");
    return `${path}${path.includes("?") ? "&" : "?"}${new URLSearchParams({ course, assignment })}`;
  }

  /**
   * The generated robot that follows the robot `after`, if possible with the situation `favour`.
   *
   * @param {number} level
   * @param {string} convention
   * @param {string | null} after
   * @param {string | null} favour
   * @returns {Promise<Api.PracticeRobot>}
   */
  nextRobot(level, convention, after, favour) {
    const query = new URLSearchParams({ level: String(level), convention });
    if (after) query.set("after", after);
    if (favour) query.set("favour", favour);
    return this.#ask(`v1/practice/next?${query}`, undefined, { own: true });
  }

  /** The courses and assignments of the learner with this token. @returns {Promise<Api.OwnCourses>} */
  own() {
    return this.#ask("v1/me", undefined, { own: true });
  }

  /** One of the learner's attempts. @param {string} id @returns {Promise<Api.AttemptDetail>} */
  attempt(id) {
    return this.#ask(`v1/attempts/${encodeURIComponent(id)}`, undefined, { own: true });
  }

  /** @param {string} path "course/assignment" @param {string} exercise @returns {Promise<Api.ModelSolution>} */
  assignedSolution(path, exercise) {
    return this.#ask(`${assigned(path)}/solutions/${encodeURIComponent(exercise)}`, undefined, { own: true });
  }

  /** @param {string} path @param {string} key @param {Api.HandInRequest} body @returns {Promise<Api.AttemptResponse>} */
  handIn(path, key, body) {
    return this.#ask(`${assigned(path)}/attempts`, body, { key });
  }

  /**
   * `own` is true if a request without a body needs the token; `key` is the Idempotency-Key.
   *
   * @param {string} path
   * @param {unknown} [body]
   * @param {{ own?: boolean, key?: string }} [options]
   */
  async #ask(path, body, { own = false, key } = {}) {
    // Responses are in the language of the page. This header needs no preflight.
    const headers = new Headers({ "Accept-Language": language });
    /** @type {RequestInit} */
    const options = { credentials: "omit", headers, signal: AbortSignal.timeout(PATIENCE) };
    if (body !== undefined) {
      options.method = "POST";
      headers.set("Content-Type", "application/json");
      options.body = JSON.stringify(body);
      if (key) headers.set("Idempotency-Key", key);
    }
    // Other requests need no token. Without the header Authorization, the browser sends no preflight for them.
    const token = own || body !== undefined ? this.token() : null;
    if (token) headers.set("Authorization", `Bearer ${token}`);
    let answer, content;
    try {
      answer = await fetch(this.address(path), options);
      content = await answer.json();
    } catch {
      throw answer === undefined || answer.ok
        ? new ServiceError("offline", worded("The service cannot be reached. Your answers are saved in this browser."))
        : failure(answer.status, {});
    }
    if (!answer.ok) throw failure(answer.status, content ?? {});
    return content;
  }
}

/** Return the path of an assignment. @param {string} path "course/assignment" */
function assigned(path) {
  const [course = "", assignment = ""] = path.split("/");
  return `v1/courses/${encodeURIComponent(course)}/assignments/${encodeURIComponent(assignment)}`;
}

/** @param {number} status @param {Partial<Api.Problem>} problem */
function failure(status, problem) {
  if (status === 429 || status === 503) {
    return new ServiceError("busy", worded("The service is busy. Try again in a few seconds."), status);
  }
  const kind = status >= 500 ? "failed" : "refused";
  if (problem.type?.endsWith("key-needed")) return new ServiceError(kind, KEY_NEEDED, status);
  return new ServiceError(
    kind,
    problem.detail ?? worded("The service answered with the status {status}.", { status }),
    status,
  );
}
