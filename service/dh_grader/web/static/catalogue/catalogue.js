// The catalogue of exercises: its search, and the progress on each exercise.

import { byId, h, points } from "../shared/dom.js";
import { progressOf } from "./progress.js";
import { matches, wordsOf } from "./search.js";
import { worded, wordedFor } from "../shared/words/words.js";

const HOME = new URL("../", import.meta.url).href;

/** @type {NodeListOf<HTMLElement>} */
const found = document.querySelectorAll(".exercises > li");
const items = [...found];
/** @type {NodeListOf<HTMLElement>} */
const groups = document.querySelectorAll(".group");

/** Show the progress on each exercise, and in each heading how many exercises are done. */
function showProgress() {
  for (const item of items) {
    const { exercise = "", points: most = "0" } = item.dataset;
    const earned = Object.values(progressOf(HOME, exercise)).reduce((sum, each) => sum + each, 0);
    const isDone = earned > 0 && earned >= Number(most);
    item.classList.toggle("is-done", isDone);
    const mark = isDone
      ? [h("span", { "aria-hidden": "true" }, "✓ "), worded("Done")]
      : earned > 0
      ? [worded("{points} so far", { points: points(earned, Number(most)) })]
      : [];
    item.querySelector(".done")?.replaceChildren(...mark);
  }
  for (const group of groups) {
    const all = group.querySelectorAll(".exercises > li").length;
    const done = group.querySelectorAll(".is-done").length;
    group.querySelector(".done-count")?.replaceChildren(done ? worded("{done} of {all} done", { done, all }) : "");
  }
}

const field = byId("search", HTMLInputElement);
const words = items.map((item) => wordsOf(item.querySelector(".words")?.textContent ?? ""));

/** Show only the exercises that have all words of the search. */
function narrow() {
  items.forEach((item, i) => (item.hidden = !matches(words[i], field.value)));
  for (const group of groups) group.hidden = !group.querySelector(".exercises > li:not([hidden])");
  const left = items.filter((item) => !item.hidden).length;
  byId("count", HTMLElement).textContent = field.value.trim()
    ? worded("{left} of {all}", { left, all: items.length })
    : wordedFor("1 exercise", "{count} exercises", items.length);
  const none = document.getElementById("none-found");
  if (!none) return;
  none.hidden = left > 0;
  none.textContent = worded("No exercise has all these words.");
}

if (items.length) {
  byId("search-form", HTMLElement).hidden = false;
  byId("search-form", HTMLElement).addEventListener("submit", (event) => event.preventDefault());
  field.addEventListener("input", narrow);
  narrow();
  showProgress();
  // When the student goes back, the browser may show the page with its earlier progress.
  addEventListener("pageshow", showProgress);
}
