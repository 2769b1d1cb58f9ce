// The script of the service's own pages: the choice of light or dark colours, and the choice of a language.

import { byId, h } from "./dom.js";
import { worded } from "./words/words.js";

const NAME = "dh-grader:theme";
const THEMES = { auto: worded("System"), light: worded("Light"), dark: worded("Dark") };

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
  { "aria-label": worded("Colours"), onchange: (event) => choose(event.target.value) },
  ...Object.entries(THEMES).map(([value, text]) => h("option", { value, selected: value === kept() }, text)),
);
show(kept());
byId("theme", HTMLElement).append(theme);

// The link to another language keeps the page's address, with its query and fragment.
for (const link of document.querySelectorAll(".languages a")) {
  if (!(link instanceof HTMLAnchorElement)) continue;
  const lang = new URL(link.href).searchParams.get("lang") ?? "";
  link.addEventListener("click", () => {
    const address = new URL(location.href);
    address.searchParams.set("lang", lang);
    link.href = address.href;
  });
}
