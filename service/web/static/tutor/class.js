// The report on a class: the service grades local files or an archive, and a frame shows the report.

import { byId, h, visible, whenChosen } from "../shared/dom.js";
import { documentOf } from "../shared/markup.js";
import { language, worded, wordedFor } from "../shared/words/words.js";
import { post, refusal } from "./tutor_service.js";
import { archiveOf, bytesOf, entries, textOf } from "./zip.js";

// The service's limits, in bytes, on a packed body and on one file. For a larger file, only the name is sent.
const MOST_PACKED = 256 * 1024;
const LARGEST_FILE = 256 * 1024;
const MOST_FILES = 2000;
// Files of office programs are zip files, which may have pictures in them. The limits on one of them and on the texts
// in it, in bytes, and on the number of texts.
const OFFICE = /\.(?:xlsx|docx|ods)$/i;
const LARGEST_OFFICE = 8 * 1024 * 1024;
const LARGEST_TEXTS = 512 * 1024;
const MOST_TEXTS = 100;
// The limits, in bytes, on a chosen archive, and on all its unpacked files together.
const LARGEST_ARCHIVE = 200 * 1024 * 1024;
const MOST_UNPACKED = 8 * 1024 * 1024;
const INDEX = "index.html";
const GRADES = "grades.csv";
const PAGES = "reports/";
const TOO_LARGE = worded("The files are too large for this page. Grade them on the command line.");

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
  const address = `../v1/exercises/${encodeURIComponent(chosen)}?lang=${language}`;
  const answer = await fetch(address).catch(() => null);
  if (!answer?.ok || chosen !== exercise.value) return;
  /** @type {Api.Exercise} */
  const { parts } = await answer.json();
  part.replaceChildren(
    h("option", { value: "" }, worded("All parts")),
    ...parts.map(({ id, title }) => h("option", { value: id }, visible(title))),
  );
}

/**
 * A file of a student. `read` returns the file's bytes, or null if there are more than `most` bytes.
 *
 * @typedef {{ path: string, read: (most: number) => Promise<Uint8Array<ArrayBuffer> | null> }} ClassFile
 */

/** The chosen files cannot be used; the message gives the reason. */
class UnusableFilesError extends Error {}

/** @param {File} file @returns {ClassFile} */
function chosenFile(file) {
  // Omit the name of the chosen folder.
  const path = file.webkitRelativePath.split("/").slice(1).join("/") || file.name;
  return { path, read: async (most) => file.size > most ? null : new Uint8Array(await file.arrayBuffer()) };
}

/**
 * Return the files in an archive. If one folder contains all files and has the archive's name, omit this folder.
 *
 * @param {File} file
 * @returns {Promise<ClassFile[]>}
 */
async function unpacked(file) {
  if (file.size > LARGEST_ARCHIVE) {
    throw new UnusableFilesError(worded("The zip file is too large for this page. Unpack it, and choose the folder."));
  }
  const buffer = await file.arrayBuffer();
  let found;
  try {
    found = [...entries(buffer)];
  } catch {
    throw new UnusableFilesError(worded("The zip file is damaged. Download it again."));
  }
  if (found.some(([, { isReadable }]) => !isReadable)) {
    throw new UnusableFilesError(
      worded("The zip file is encrypted, or packed in an unusual way. Unpack it, and choose the folder."),
    );
  }
  const folder = file.name.replace(/\.zip$/i, "/");
  const start = found.every(([name]) => name.startsWith(folder)) ? folder.length : 0;
  return found.map(([name, entry]) => ({ path: name.slice(start), read: (most) => bytesOf(buffer, entry, most) }));
}

/**
 * Return the files in the form that the service takes: as text if they are UTF-8, as the texts in a file of an
 * office program, otherwise as bytes.
 *
 * @param {ClassFile[]} files
 */
async function sent(files) {
  let left = MOST_UNPACKED;
  const all = [];
  for (const { path, read } of files) {
    const isOffice = OFFICE.test(path);
    const bytes = await read(isOffice ? LARGEST_OFFICE : LARGEST_FILE).catch(() => {
      throw new UnusableFilesError(worded("The file {path} cannot be read.", { path }));
    });
    const members = bytes && isOffice ? await texts(bytes.slice().buffer) : null;
    const known = members ? { members } : bytes && bytes.length <= LARGEST_FILE ? content(bytes) : {};
    left -= Object.values(members ?? known).reduce((length, each) => length + each.length, 0);
    if (left < 0) throw new UnusableFilesError(TOO_LARGE);
    all.push({ path, ...known });
  }
  return all;
}

/**
 * Return the texts in a file of an office program, by their names, or null if it is none. What students write is in
 * them; packed together, they need a tenth of the files, so that those of a whole class fit. Pictures and themes stay
 * empty: only their names tell the service what is in the file.
 *
 * @param {ArrayBuffer} file
 * @returns {Promise<Record<string, string> | null>}
 */
async function texts(file) {
  try {
    /** @type {Record<string, string>} */
    const found = {};
    let left = LARGEST_TEXTS;
    for (const [name, entry] of entries(file)) {
      const isText = /(?:\.xml|\.rels|^mimetype)$/.test(name) && !name.includes("theme/");
      const bytes = isText && entry.isReadable ? await bytesOf(file, entry, left) : new Uint8Array();
      if (!bytes || (isText && !entry.isReadable)) return null;
      left -= bytes.length;
      found[name] = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
    }
    return Object.keys(found).length > MOST_TEXTS ? null : found;
  } catch {
    return null;
  }
}

/** @param {Uint8Array<ArrayBuffer>} bytes */
function content(bytes) {
  try {
    return { text: new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes) };
  } catch {
    return { base64: btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")) };
  }
}

/** @param {ClassFile} file */
const isHidden = ({ path }) => path.split("/").some((name) => name.startsWith(".") || name === "__MACOSX");

/** @param {File[]} chosen @returns {Promise<ClassFile[]>} */
async function classFiles(chosen) {
  const [first] = chosen;
  const isArchive = chosen.length === 1 && !first.webkitRelativePath && /\.zip$/i.test(first.name);
  const files = isArchive ? await unpacked(first) : chosen.map(chosenFile);
  return files.filter((file) => !isHidden(file));
}

/** @param {File[]} chosen */
async function grade(chosen) {
  frame.hidden = bar.hidden = true;
  try {
    const files = await classFiles(chosen);
    if (!files.length) return tell(worded("No files found."));
    if (files.length > MOST_FILES) {
      return tell(
        worded("{count} files are too many for this page. Grade them on the command line.", { count: files.length }),
      );
    }
    tell(wordedFor("Grading {count} file …", "Grading {count} files …", files.length));
    const upload = { exercise: exercise.value, part: part.value || null, files: await sent(files) };
    const packed = new Blob([JSON.stringify(upload)]).stream().pipeThrough(new CompressionStream("gzip"));
    const body = await new Response(packed).arrayBuffer();
    if (body.byteLength > MOST_PACKED) return tell(TOO_LARGE);
    archive = await (await post("../tutor/class", body, "application/gzip")).arrayBuffer();
    found = entries(archive);
    await show(INDEX);
    tell(
      wordedFor(
        "{count} submission. The service does not keep it.",
        "{count} submissions. The service does not keep them.",
        pages().length,
      ),
    );
    bar.hidden = false;
  } catch (error) {
    tell(error instanceof UnusableFilesError ? error.message : refusal(error));
  }
}

/** Return the entries of the pages for students. */
const pages = () => [...found].filter(([name]) => name.startsWith(PAGES)).map(([, entry]) => entry);

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
  frame.title = inside.title || worded("Report");
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

/**
 * Let the browser save a file.
 *
 * @param {string} name
 * @param {(archive: ArrayBuffer) => Blob | Promise<Blob>} made
 */
async function download(name, made) {
  if (!archive) return;
  const address = URL.createObjectURL(await made(archive));
  h("a", { href: address, download: `${exercise.value}-${name}` }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

/** @param {ArrayBuffer} graded */
async function gradebook(graded) {
  const entry = found.get(GRADES);
  return new Blob(entry ? [await bytesOf(graded, entry) ?? ""] : [], { type: "text/csv" });
}

exercise.addEventListener("change", showParts);
for (const id of ["zip", "folder", "files"]) {
  const input = byId(id, HTMLInputElement);
  whenChosen(input, (files) => {
    // Empty the field, so that the tutor can choose the same files again.
    input.value = "";
    grade(files);
  });
}
back.addEventListener("click", () => show(INDEX));
/** @type {[string, string, (archive: ArrayBuffer) => Blob | Promise<Blob>][]} */
const DOWNLOADS = [
  ["grades", "grades.csv", gradebook],
  ["pages", "feedback.zip", (graded) => archiveOf(graded, pages())],
  ["all", "class.zip", (graded) => new Blob([graded], { type: "application/zip" })],
];
for (const [id, file, made] of DOWNLOADS) {
  byId(id, HTMLButtonElement).addEventListener("click", () => download(file, made));
}
showParts();
