// The script of the service's own pages: the choice of light or dark, and the search in the catalogue.

import { byId, h } from "./dom.js";

const NAME = "dh-grader:theme";
const THEMES = { auto: "System", light: "Light", dark: "Dark" };

function kept() {
  try {
    return localStorage.getItem(NAME) ?? "auto";
  } catch {
    return "auto";
  }
}

/** @param {string} theme */
function show(theme) {
  if (theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
}

/** @param {string} theme */
function choose(theme) {
  show(theme);
  try {
    localStorage.setItem(NAME, theme);
  } catch {
    // Without storage, the choice is lost when the page is closed.
  }
}

const theme = h(
  "select",
  { "aria-label": "Colours", onchange: (event) => choose(event.target.value) },
  ...Object.entries(THEMES).map(([value, text]) => h("option", { value, selected: value === kept() }, text)),
);
show(kept());
byId("theme", HTMLElement).append(theme);

const field = document.getElementById("search");
if (field instanceof HTMLInputElement) {
  /** @type {NodeListOf<HTMLElement>} */
  const found = document.querySelectorAll(".exercises > li");
  const items = [...found];
  const texts = items.map((item) => item.textContent.toLowerCase());
  const none = byId("none-found", HTMLElement);
  const count = byId("count", HTMLElement);
  const narrow = () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    items.forEach((item, i) => (item.hidden = !words.every((word) => texts[i].includes(word))));
    /** @type {NodeListOf<HTMLElement>} */
    const groups = document.querySelectorAll(".group");
    for (const group of groups) {
      group.hidden = !group.querySelector(".exercises > li:not([hidden])");
    }
    const left = items.filter((item) => !item.hidden).length;
    count.textContent = words.length ? `${left} of ${items.length}` : `${items.length} exercises`;
    none.hidden = left > 0;
    none.textContent = "No exercise has all these words.";
  };
  const { form } = field;
  if (form) {
    form.hidden = false;
    form.addEventListener("submit", (event) => event.preventDefault());
  }
  field.addEventListener("input", narrow);
  narrow();
}
