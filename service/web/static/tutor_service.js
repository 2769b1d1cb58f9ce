// What a tutor's pages ask the service for.

/** The answer to a body; throws an Error with the reason where it is refused. */
export async function post(path, body, type = "application/json") {
  const answer = await fetch(path, { method: "POST", headers: { "Content-Type": type }, body });
  if (answer.ok) return answer;
  const problem = await answer.json().catch(() => ({}));
  throw Object.assign(new Error(problem.detail ?? `The service answered with the status ${answer.status}.`), { told: true });
}

/** The words for a request that failed. */
export function refusal(error) {
  return error.told ? error.message : "The service cannot be reached.";
}
