// The service over HTTP: each failure is one kind of error with words for the student.

// Longer than any grading: whoever waits so long has no connection.
const PATIENCE = 20_000;
// A student has no key: that is the course's site's.
const KEY_NEEDED = "Open this exercise from your course's site: here it needs a key.";

/** A request that failed. `kind` is "offline", "busy", "refused" or "failed". */
export class ServiceError extends Error {
  constructor(kind, text, status = 0) {
    super(text);
    this.kind = kind;
    this.status = status;
  }
}

export class Service {
  /** `base` is the address of the service, with a slash at its end; `token` gives that of the learner, if any. */
  constructor(base, token = () => null) {
    this.base = base;
    this.token = token;
  }

  address(path) {
    return new URL(path, this.base).href;
  }

  exercise(id) {
    return this.#ask(`v1/exercises/${encodeURIComponent(id)}`);
  }

  preview(body) {
    return this.#ask("v1/preview", body);
  }

  previews(body) {
    return this.#ask("v1/previews", body);
  }

  grade(id, body) {
    return this.#ask(`v1/exercises/${encodeURIComponent(id)}/grade`, body);
  }

  frames(body) {
    return this.#ask("v1/frames", body);
  }

  async #ask(path, body) {
    const options = { credentials: "omit", headers: {}, signal: AbortSignal.timeout(PATIENCE) };
    if (body !== undefined) {
      options.method = "POST";
      options.headers["Content-Type"] = "application/json";
      options.body = JSON.stringify(body);
      // What is only read needs none, and is asked for without a question beforehand.
      const token = this.token();
      if (token) options.headers.Authorization = `Bearer ${token}`;
    }
    let answer, content;
    try {
      answer = await fetch(this.address(path), options);
      content = await answer.json();
    } catch {
      throw answer === undefined || answer.ok
        ? new ServiceError("offline", "The service cannot be reached. Your answers are kept in this browser.")
        : failure(answer.status, {});
    }
    if (!answer.ok) throw failure(answer.status, content);
    return content;
  }
}

function failure(status, problem) {
  if (status === 429 || status === 503) {
    return new ServiceError("busy", "The service has a lot to do. Try again in a few seconds.", status);
  }
  const kind = status >= 500 ? "failed" : "refused";
  if (problem.type?.endsWith("key-needed")) return new ServiceError(kind, KEY_NEEDED, status);
  return new ServiceError(kind, problem.detail ?? `The service answered with the status ${status}.`, status);
}
