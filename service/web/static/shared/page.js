// The script of the service's own pages: the choice of light or dark.

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
