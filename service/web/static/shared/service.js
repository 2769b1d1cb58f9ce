// Requests to the service. Each failure is a ServiceError with a message for the student.

// Milliseconds until a request fails; longer than any grading.
const PATIENCE = 20_000;
// Students have no key; the course's site has it.
const KEY_NEEDED = "Please open this exercise from your course page.";

/** A request that failed. `kind` is "offline", "busy", "refused" or "failed". */
export class ServiceError extends Error {
  /** @param {"offline" | "busy" | "refused" | "failed"} kind @param {string} text @param {number} [status] */
  constructor(kind, text, status = 0) {
    super(text);
    this.kind = kind;
    this.status = status;
  }
}

export class Service {
  /**
   * `base` is the address of the service, with a slash at its end. `token` returns the learner's token, or null.
   *
   * @param {string} base
   * @param {() => string | null} [token]
   */
  constructor(base, token = () => null) {
    this.base = base;
    this.token = token;
  }

  /** @param {string} path */
  address(path) {
    return new URL(path, this.base).href;
  }

  /** @param {string} id @returns {Promise<Api.Exercise>} */
  exercise(id) {
    return this.#ask(`v1/exercises/${encodeURIComponent(id)}`);
  }

  /** @param {Api.PreviewRequest} body @returns {Promise<Api.Preview>} */
  preview(body) {
    return this.#ask("v1/preview", body);
  }

  /** @param {Api.PreviewManyRequest} body @returns {Promise<Api.PreviewManyResponse>} */
  previews(body) {
    return this.#ask("v1/previews", body);
  }

  /** @param {string} id @param {Api.GradeRequest} body @returns {Promise<Api.Report>} */
  grade(id, body) {
    return this.#ask(`v1/exercises/${encodeURIComponent(id)}/grade`, body);
  }

  /** @param {Api.FramesRequest} body @returns {Promise<Api.Frames>} */
  frames(body) {
    return this.#ask("v1/frames", body);
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
    const headers = new Headers();
    /** @type {RequestInit} */
    const options = { credentials: "omit", headers, signal: AbortSignal.timeout(PATIENCE) };
    if (body !== undefined) {
      options.method = "POST";
      headers.set("Content-Type", "application/json");
      options.body = JSON.stringify(body);
      if (key) headers.set("Idempotency-Key", key);
    }
    // Other requests need no token; without this header, the browser sends them without a preflight.
    const token = own || body !== undefined ? this.token() : null;
    if (token) headers.set("Authorization", `Bearer ${token}`);
    let answer, content;
    try {
      answer = await fetch(this.address(path), options);
      content = await answer.json();
    } catch {
      throw answer === undefined || answer.ok
        ? new ServiceError("offline", "The service cannot be reached. Your answers are saved in this browser.")
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
    return new ServiceError("busy", "The service is busy. Try again in a few seconds.", status);
  }
  const kind = status >= 500 ? "failed" : "refused";
  if (problem.type?.endsWith("key-needed")) return new ServiceError(kind, KEY_NEEDED, status);
  return new ServiceError(kind, problem.detail ?? `The service answered with the status ${status}.`, status);
}
