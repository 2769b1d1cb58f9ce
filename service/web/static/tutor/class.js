// The report on a class: local files, graded by the service and shown in a frame.

import { byId, h, visible } from "../shared/dom.js";
import { documentOf } from "../shared/markup.js";
import { post, refusal } from "./tutor_service.js";
import { entries, textOf } from "./zip.js";

// The service's limits, in bytes, on a packed body and on one file. Of a larger file only the name is sent.
const MOST_PACKED = 256 * 1024;
const LARGEST_FILE = 256 * 1024;
const MOST_FILES = 2000;
const INDEX = "index.html";

const exercise = byId("exercise", HTMLSelectElement);
const part = byId("part", HTMLSelectElement);
const frame = byId("report", HTMLIFrameElement);
const bar = byId("report-bar", HTMLElement);
const state = byId("state", HTMLElement);
const back = byId("back", HTMLButtonElement);
/** @type {Promise<unknown>} */
let shown = Promise.resolve();

/** @type {ArrayBuffer | null} */
let archive = null;
/** @type {Map<string, Front.ZipEntry>} */
let found = new Map();

/** @param {string} text */
const tell = (text) => (state.textContent = visible(text));

async function showParts() {
  const chosen = exercise.value;
  const answer = await fetch(`../v1/exercises/${encodeURIComponent(chosen)}`).catch(() => null);
  if (!answer?.ok || chosen !== exercise.value) return;
  /** @type {Api.Exercise} */
  const { parts } = await answer.json();
  part.replaceChildren(
    h("option", { value: "" }, "All parts"),
    ...parts.map(({ id, title }) => h("option", { value: id }, visible(title))),
  );
}

/**
 * Return a file as the service takes it: as text if it is UTF-8, otherwise as bytes.
 *
 * @param {File} file
 */
async function sent(file) {
  // Without the name of the chosen folder itself.
  const path = file.webkitRelativePath.split("/").slice(1).join("/") || file.name;
  if (file.size > LARGEST_FILE) return { path };
  const bytes = new Uint8Array(await file.arrayBuffer());
  try {
    return { path, text: new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes) };
  } catch {
    return { path, base64: btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")) };
  }
}

/** @param {File} file */
const isHidden = (file) => (file.webkitRelativePath || file.name).split("/").some((name) => name.startsWith("."));

/** @param {HTMLInputElement} input */
async function grade(input) {
  const files = [...(input.files ?? [])].filter((file) => !isHidden(file));
  input.value = "";
  frame.hidden = bar.hidden = true;
  if (!files.length) return tell("No files found.");
  if (files.length > MOST_FILES) {
    return tell(`${files.length} files are too many for this page. Grade them on the command line.`);
  }
  tell(`Grading ${files.length} ${files.length === 1 ? "file" : "files"} …`);
  const upload = { exercise: exercise.value, part: part.value || null, files: await Promise.all(files.map(sent)) };
  const packed = new Blob([JSON.stringify(upload)]).stream().pipeThrough(new CompressionStream("gzip"));
  const body = await new Response(packed).arrayBuffer();
  if (body.byteLength > MOST_PACKED) {
    return tell("The files are too large for this page. Grade them on the command line.");
  }
  try {
    archive = await (await post("../tutor/class", body, "application/gzip")).arrayBuffer();
    found = entries(archive);
    await show(INDEX);
    tell(`${found.size - 1} ${found.size === 2 ? "submission" : "submissions"}. The service does not keep them.`);
    bar.hidden = false;
  } catch (error) {
    tell(refusal(error));
  }
}

/**
 * Show a page of the archive in the frame, after the previous page has loaded.
 *
 * @param {string} name
 */
function show(name) {
  const next = () => load(name);
  return (shown = shown.then(next, next));
}

/** @param {string} name */
async function load(name) {
  const entry = found.get(name);
  if (!archive || !entry) return;
  const text = await textOf(archive, entry);
  // The frame's policy allows this style, but the policy of this page does not.
  const [before, style, after] = text.split(/<style>|<\/style>/);
  const page = documentOf(before + after);
  // Remove the page's own policy, which would also apply to the next page in the frame. The frame's
  // policy allows the styles of both kinds of page.
  page.querySelector("meta[http-equiv]")?.remove();
  frame.hidden = false;
  back.hidden = name === INDEX;
  // The frame's own policy allows the styles of the reports, and no script.
  await new Promise((done) => {
    frame.addEventListener("load", done, { once: true });
    frame.src = "../tutor/class/report";
  });
  const inside = frame.contentDocument;
  if (!inside) return;
  inside.replaceChild(inside.adoptNode(page.documentElement), inside.documentElement);
  inside.head.append(Object.assign(inside.createElement("style"), { textContent: style }));
  frame.title = inside.title || "Report";
  inside.addEventListener("click", follow);
}

/** @param {MouseEvent} event */
function follow(event) {
  const address = /** @type {Element | null} */ (event.target)?.closest?.("a")?.getAttribute("href");
  const name = address && !address.startsWith("#") ? decodeURIComponent(address) : null;
  if (!name) return;
  event.preventDefault();
  if (found.has(name)) show(name).then(() => frame.focus());
}

function download() {
  if (!archive) return;
  const address = URL.createObjectURL(new Blob([archive], { type: "application/zip" }));
  h("a", { href: address, download: `${exercise.value}-class.zip` }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

exercise.addEventListener("change", showParts);
for (const id of ["folder", "files"]) {
  const input = byId(id, HTMLInputElement);
  input.addEventListener("change", () => grade(input));
}
back.addEventListener("click", () => show(INDEX));
byId("download", HTMLButtonElement).addEventListener("click", download);
showParts();
