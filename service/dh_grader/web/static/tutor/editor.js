// The editor of exercise files: it runs the checks of the command line while the author types.

import { byId, h, message, visible } from "../shared/dom.js";
import { later } from "../shared/later.js";
import { html } from "../shared/markup.js";
import { worded } from "../shared/words/words.js";
import { importForm } from "./import_form.js";
import { post, refusal } from "./tutor_service.js";

// Milliseconds after the last key until the text is checked.
const PAUSE = 300;
/** @type {Record<string, string>} */
const LEVELS = { unusable: worded("cannot be used"), failed: worded("failed"), warning: worded("warning") };

const area = byId("text", HTMLTextAreaElement);
const name = byId("id", HTMLInputElement);
const numbers = byId("numbers", HTMLElement);
const saved = byId("saved", HTMLElement);
const found = byId("findings", HTMLElement);
const shown = byId("preview", HTMLElement);

const form = byId("form", HTMLElement);
const tryButton = byId("try", HTMLButtonElement);
const tried = byId("try-state", HTMLElement);

/** @typedef {{ level: string, field?: string, text: string, line?: number }} Finding */
/** @typedef {{ title: string, source: string, statement_html: string, parts: string[], figure?: string }} Preview */
/** @typedef {{ findings: Finding[], summary: string, preview?: Preview }} Checked */

let mark = byId("main", HTMLElement).dataset.mark;
let kept = area.value;
let timer = 0;
let busy = false;
let picture = "";
let draft = "";

const body = () => ({ id: name.value.trim(), text: area.value });

function edited() {
  const lines = area.value.split("\n").length;
  if (numbers.childElementCount !== lines) {
    numbers.replaceChildren(...Array.from({ length: lines }, (_, i) => h("span", {}, String(i + 1))));
  }
  clearTimeout(timer);
  timer = setTimeout(check, PAUSE);
}

/** Request the findings. Only one request runs at a time; the newest text is always checked. */
async function check() {
  if (busy) return;
  busy = true;
  const asked = body();
  try {
    show(await (await post("../tutor/check", JSON.stringify(asked))).json());
  } catch (error) {
    found.replaceChildren(h("h2", {}, worded("Findings")), h("p", { class: "level-unusable" }, refusal(error)));
  }
  busy = false;
  const now = body();
  if (now.text !== asked.text || now.id !== asked.id) timer = setTimeout(check, PAUSE);
}

/** @param {Checked} checked */
function show({ findings, summary, preview }) {
  const marked = new Set(findings.map(({ line }) => line).filter(Boolean));
  [...numbers.children].forEach((each, i) => each.classList.toggle("marked", marked.has(i + 1)));
  const verdict = findings.some(({ level }) => level !== "warning") ? "incorrect" : "correct";
  const told = { incorrect: "✗ ", correct: "✓ " }[verdict];
  found.replaceChildren(
    h("h2", {}, worded("Findings")),
    h("p", { class: `verdict ${verdict}` }, h("span", { "aria-hidden": "true" }, told), visible(summary)),
    findings.length ? h("ul", {}, ...findings.map(item)) : h("p", { class: "quiet" }, worded("No problems found.")),
  );
  if (preview) showPreview(preview);
  else shown.classList.add("outdated");
}

/** @param {Finding} finding */
function item({ level, field, text, line }) {
  const place = line
    ? h("button", { type: "button", class: "line", onclick: () => go(line) }, worded("line {line}", { line }))
    : null;
  return h(
    "li",
    {},
    h("span", { class: `level level-${level}` }, LEVELS[level] ?? level),
    place,
    field ? h("code", {}, visible(field)) : null,
    h("p", {}, ...message(text)),
  );
}

/**
 * Select a line of the text.
 *
 * @param {number} line
 */
function go(line) {
  const lines = area.value.split("\n");
  const from = lines.slice(0, line - 1).reduce((length, each) => length + each.length + 1, 0);
  area.focus();
  area.setSelectionRange(from, from + lines[line - 1].length);
  area.scrollTop = (line - 4) * parseFloat(getComputedStyle(area).lineHeight);
}

/** @param {Preview} preview */
function showPreview({ title, source, statement_html: statement, parts, figure }) {
  URL.revokeObjectURL(picture);
  picture = figure ? URL.createObjectURL(new Blob([figure], { type: "image/svg+xml" })) : "";
  shown.classList.remove("outdated");
  shown.replaceChildren(
    h("h2", {}, worded("What students see")),
    h("h3", {}, visible(title)),
    h("p", { class: "quiet" }, visible(source)),
    picture
      ? h(
        "figure",
        {},
        h("img", { src: picture, alt: worded("Drawing of the robot: {title}", { title: visible(title) }) }),
      )
      : "",
    h("div", { class: "statement" }, ...html(statement)),
    h("ol", {}, ...parts.map((part) => h("li", {}, visible(part)))),
  );
}

/** Show the students' form for the present text. Answers stay when the form is opened again. */
async function tryOut() {
  tried.textContent = "";
  try {
    const answer = await post("../tutor/drafts", JSON.stringify({ ...body(), draft }));
    ({ draft } = await answer.json());
    await later(import.meta.resolve("../student/embed.js"), () => import("../student/embed.js"));
    const element = document.createElement("dh-exercise");
    element.setAttribute("exercise", draft);
    form.replaceChildren(element);
    tryButton.textContent = worded("Update the form");
  } catch (error) {
    tried.textContent = refusal(error);
  }
}

function download() {
  const address = URL.createObjectURL(new Blob([area.value], { type: "application/toml" }));
  h("a", { href: address, download: `${name.value.trim() || "exercise"}.toml` }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
  kept = area.value;
  saved.textContent = worded("Downloaded");
}

async function save() {
  const asked = body();
  try {
    const answer = await post("../tutor/files", JSON.stringify({ ...asked, before: mark }));
    ({ mark } = await answer.json());
    kept = asked.text;
    saved.textContent = worded("{file} is saved", { file: `${asked.id}.toml` });
  } catch (error) {
    saved.textContent = refusal(error);
  }
}

area.addEventListener("input", () => {
  saved.textContent = "";
  edited();
});
area.addEventListener("scroll", () => (numbers.scrollTop = area.scrollTop));
name.addEventListener("input", () => {
  // Another name is another file.
  mark = "";
  edited();
});
tryButton.addEventListener("click", tryOut);
byId("download", HTMLButtonElement).addEventListener("click", download);
document.getElementById("save")?.addEventListener("click", save);
name.form?.addEventListener("submit", (event) => event.preventDefault());
if (document.getElementById("import")) {
  const proposed = name.value;
  importForm({
    id: () => name.value.trim(),
    named: (id) => {
      if (id && name.value === proposed) name.value = id;
    },
    written: (text) => {
      area.value = text;
      saved.textContent = "";
      edited();
    },
  });
  if (location.hash === "#import") byId("import", HTMLDetailsElement).open = true;
}
addEventListener("beforeunload", (event) => {
  if (area.value !== kept) event.preventDefault();
});
edited();
