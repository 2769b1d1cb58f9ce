// The key in a personal link, and the places on the learner's page. The key stays in this tab until it is closed.

const NAME = "dh-grader:link";
const LINK = /^#(dhg_[\w.-]+)$/;
const PLACE = /^#\/([^/]+)\/([^/]+)\/([^/]+)(?:\/([^/]+))?$/;

let inMemory = "";
let isOfPage = false;

/** Return true if a platform has opened the page. Such a page contains a key, which is only kept in memory. */
export function takePageKey() {
  const { key = "", place = "" } = document.getElementById("learner")?.dataset ?? {};
  if (key) {
    inMemory = key;
    isOfPage = true;
    document.getElementById("learner")?.removeAttribute("data-key");
    if (place && !location.hash) history.replaceState(null, "", place);
  }
  return isOfPage;
}

/** Return the key in the address, or else the last key in this tab, or an empty text if there is no key. */
export function takeKey() {
  if (isOfPage) return inMemory;
  const [, key] = LINK.exec(location.hash) ?? [];
  try {
    if (key) sessionStorage.setItem(NAME, key);
    else inMemory ||= sessionStorage.getItem(NAME) ?? "";
  } catch {
    // Without storage, a reload needs the link again.
  }
  if (key) {
    inMemory = key;
    // Nobody reads the key in the address bar, in the history or on a screenshot.
    history.replaceState(null, "", location.pathname);
  }
  return inMemory;
}

export function forgetKey() {
  inMemory = "";
  try {
    sessionStorage.removeItem(NAME);
  } catch {
    // There is nothing to remove.
  }
}

/**
 * Return the exercise that a fragment names, or null for the list of assignments.
 *
 * @param {string} hash
 * @returns {Front.Assigned | null}
 */
export function placeIn(hash) {
  const found = PLACE.exec(hash);
  if (!found) return null;
  try {
    const [course, assignment, exercise, attempt] = found.slice(1).map((each) => each && decodeURIComponent(each));
    return { path: `${course}/${assignment}`, exercise, ...(attempt ? { attempt } : {}) };
  } catch {
    return null;
  }
}

/** Return the fragment of an exercise, or of one of its attempts. @param {Front.Assigned} place */
export function fragmentOf({ path, exercise, attempt }) {
  return `#/${[...path.split("/"), exercise, ...(attempt ? [attempt] : [])].map(encodeURIComponent).join("/")}`;
}
