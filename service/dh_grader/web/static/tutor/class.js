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
const FILLED = "worksheet-graded.csv";
const TOLD = "worksheet.txt";
const LARGEST_WORKSHEET = 1024 * 1024;
const ARCHIVE = /\.zip$/i;
const TOO_LARGE = worded("The files are too large for this page. Grade them on the command line.");

const exercise = byId("exercise", HTMLSelectElement);
const part = byId("part", HTMLSelectElement);
const frame = byId("report", HTMLIFrameElement);
const bar = byId("report-bar", HTMLElement);
const state = byId("state", HTMLElement);
const back = byId("back", HTMLButtonElement);
const worksheet = byId("worksheet", HTMLInputElement);
const column = byId("column", HTMLInputElement);
const filled = byId("filled", HTMLButtonElement);
const told = byId("worksheet-told", HTMLUListElement);
/** @type {Promise<unknown>} */
let shown = Promise.resolve();

/** @type {ArrayBuffer | null} */
let archive = null;
/** @type {Map<string, Front.ZipEntry>} */
let found = new Map();
/** @type {File[]} */
let files = [];

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
  return filesIn(await file.arrayBuffer(), file.name.replace(ARCHIVE, "/"));
}

/**
 * Return the files in an archive, without the folder around all of them if it has this name.
 *
 * @param {ArrayBuffer} buffer
 * @param {string} folder
 * @returns {ClassFile[]}
 */
function filesIn(buffer, folder) {
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

/**
 * Return the files with those in zip files of a class: a zip file that is the only file, or too large to be that of a
 * student.
 *
 * @param {ClassFile[]} files
 * @returns {Promise<ClassFile[]>}
 */
async function withInnerFiles(files) {
  const all = [];
  for (const file of files) {
    const { path, read } = file;
    const mayBeClass = ARCHIVE.test(path) && !path.includes("/");
    const isLarge = mayBeClass && (files.length === 1 || !(await read(LARGEST_FILE)));
    const bytes = isLarge ? await read(LARGEST_ARCHIVE) : null;
    const folder = path.replace(ARCHIVE, "/");
    try {
      const inner = bytes ? filesIn(bytes.slice().buffer, folder) : null;
      all.push(...(inner?.map((each) => ({ ...each, path: folder + each.path })) ?? [file]));
    } catch (error) {
      // The service lists the damaged file of one of several students.
      if (files.length === 1) throw error;
      all.push(file);
    }
  }
  return all;
}

/** @param {ClassFile} file */
const isHidden = ({ path }) => path.split("/").some((name) => /^\.(?!\.?$)/.test(name) || name === "__MACOSX");

/** @param {File[]} chosen @returns {Promise<ClassFile[]>} */
async function classFiles(chosen) {
  const [first] = chosen;
  const isArchive = chosen.length === 1 && !first.webkitRelativePath && /\.zip$/i.test(first.name);
  const files = isArchive ? await unpacked(first) : chosen.map(chosenFile);
  const own = await withInnerFiles(files.filter((file) => !isHidden(file)));
  return own.filter((file) => !isHidden(file));
}

/** Return the worksheet in the form that the service takes, or null. */
async function sentWorksheet() {
  const [file] = worksheet.files ?? [];
  if (!file) return null;
  if (file.size > LARGEST_WORKSHEET) {
    throw new UnusableFilesError(worded("{name} is too large for this page.", { name: file.name }));
  }
  return { path: file.name, ...content(new Uint8Array(await file.arrayBuffer())) };
}

/** @param {File[]} chosen */
async function grade(chosen) {
  files = chosen;
  frame.hidden = bar.hidden = told.hidden = true;
  try {
    const own = await classFiles(chosen);
    if (!own.length) return tell(worded("No files found."));
    if (own.length > MOST_FILES) {
      return tell(
        worded("{count} files are too many for this page. Grade them on the command line.", { count: own.length }),
      );
    }
    tell(wordedFor("Grading {count} file …", "Grading {count} files …", own.length));
    const upload = {
      exercise: exercise.value,
      part: part.value || null,
      worksheet: await sentWorksheet(),
      column: column.value.trim() || null,
      files: await sent(own),
    };
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
    await showWorksheet(archive);
    bar.hidden = false;
  } catch (error) {
    tell(error instanceof UnusableFilesError ? error.message : refusal(error));
  }
}

/** @param {ArrayBuffer} graded */
async function showWorksheet(graded) {
  const entry = found.get(TOLD);
  filled.hidden = !found.has(FILLED);
  told.hidden = !entry;
  const lines = entry ? (await textOf(graded, entry)).split("\n") : [];
  told.replaceChildren(...lines.map((line) => h("li", {}, line)));
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
  h("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

/** @param {ArrayBuffer} graded @param {string} name */
async function table(graded, name) {
  const entry = found.get(name);
  return new Blob(entry ? [await bytesOf(graded, entry) ?? ""] : [], { type: "text/csv" });
}

/** Return the name of the filled worksheet: `Grades-graded.csv` for `Grades.csv`. */
const filledName = () => (worksheet.files?.[0]?.name ?? FILLED).replace(/(\.[^.]*)?$/, "-graded$1");

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
// A worksheet or a column that is chosen after the files is used at once.
for (const input of [worksheet, column]) {
  input.addEventListener("change", () => {
    if (files.length) grade(files);
  });
}
filled.addEventListener("click", () => download(filledName(), (graded) => table(graded, FILLED)));
/** @type {[string, string, (archive: ArrayBuffer) => Blob | Promise<Blob>][]} */
const DOWNLOADS = [
  ["grades", "grades.csv", (graded) => table(graded, GRADES)],
  ["pages", "feedback.zip", (graded) => archiveOf(graded, pages())],
  ["all", "class.zip", (graded) => new Blob([graded], { type: "application/zip" })],
];
for (const [id, file, made] of DOWNLOADS) {
  byId(id, HTMLButtonElement).addEventListener("click", () => download(`${exercise.value}-${file}`, made));
}
showParts();
