// The progress in "DH in ten minutes", kept in the browser. A browser without storage is no error.

const NAME = "dh-grader:learn-dh";

/** @typedef {{ convention: Api.Convention, solved: string[] }} Kept */

/** @returns {Kept} */
export function keptProgress() {
  /** @type {any} */
  let kept = null;
  try {
    kept = JSON.parse(localStorage.getItem(NAME) ?? "null");
  } catch {
    // It begins again.
  }
  const solved = Array.isArray(kept?.solved) ? kept.solved : [];
  return {
    convention: kept?.convention === "modified" ? "modified" : "standard",
    solved: solved.filter((/** @type {unknown} */ each) => typeof each === "string"),
  };
}

/** @param {Kept} progress */
export function keepProgress(progress) {
  try {
    // Another tab may have solved others.
    const solved = [...new Set([...keptProgress().solved, ...progress.solved])];
    localStorage.setItem(NAME, JSON.stringify({ ...progress, solved }));
  } catch {
    // The progress is lost when the page is closed.
  }
}
