// What the service's own pages add: the choice of light or dark, and the search in the catalogue.

import { h } from "./dom.js";

const NAME = "dh-grader:theme";
const THEMES = { auto: "System", light: "Light", dark: "Dark" };

function kept() {
  try {
    return localStorage.getItem(NAME) ?? "auto";
  } catch {
    return "auto";
  }
}

function show(theme) {
  if (theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
}

function choose(theme) {
  show(theme);
  try {
    localStorage.setItem(NAME, theme);
  } catch {
    // The choice then lasts as long as the page.
  }
}

const theme = h(
  "select",
  { "aria-label": "Colours", onchange: (event) => choose(event.target.value) },
  ...Object.entries(THEMES).map(([value, text]) => h("option", { value, selected: value === kept() }, text)),
);
show(kept());
document.getElementById("theme").append(theme);

const field = document.getElementById("search");
if (field) {
  const items = [...document.querySelectorAll(".exercises > li")];
  const texts = items.map((item) => item.textContent.toLowerCase());
  const none = document.getElementById("none-found");
  const count = document.getElementById("count");
  const narrow = () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    items.forEach((item, i) => (item.hidden = !words.every((word) => texts[i].includes(word))));
    for (const group of document.querySelectorAll(".group")) {
      group.hidden = !group.querySelector(".exercises > li:not([hidden])");
    }
    const found = items.filter((item) => !item.hidden).length;
    count.textContent = words.length ? `${found} of ${items.length}` : `${items.length} exercises`;
    none.hidden = found > 0;
    none.textContent = "No exercise has all these words.";
  };
  field.form.hidden = false;
  field.form.addEventListener("submit", (event) => event.preventDefault());
  field.addEventListener("input", narrow);
  narrow();
}
