// The forms of the pages of courses. Each posts its fields as JSON to the route in its attribute data-post.

import { h, whenChosen } from "../../shared/dom.js";
import { failed, tell } from "../records/records.js";
import { address, send } from "../tutor_service.js";
import { doneBy, faultsIn } from "./course_words.js";

/** @typedef {HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement} Field */

/**
 * Return the value of a field for JSON; null if the field is empty.
 *
 * @param {string} kind
 * @param {string} text
 */
export function valueOf(kind, text) {
  const trimmed = text.trim();
  if (trimmed === "") return null;
  if (kind === "number") return Number(trimmed);
  if (kind === "words") return words(trimmed);
  if (kind === "numbers") return words(trimmed).map(Number);
  if (kind === "list") return [text];
  return kind === "text" ? trimmed : text;
}

/** @param {string} text */
const words = (text) => text.split(/[\s,;]+/u).filter(Boolean);

/** @param {HTMLFormElement} form */
function bodyOf(form) {
  /** @type {Record<string, unknown>} */
  const body = {};
  /** @type {NodeListOf<Field>} */
  const fields = form.querySelectorAll("[name][data-as]");
  for (const field of fields) {
    const isFlag = field instanceof HTMLInputElement && field.dataset.as === "flag";
    body[field.name] = isFlag ? field.checked : valueOf(field.dataset.as ?? "", field.value);
  }
  for (const list of form.querySelectorAll("fieldset[data-list]")) body.exercises = exercisesOf(list);
  return body;
}

/** @param {Element} list */
function exercisesOf(list) {
  const chosen = [...list.querySelectorAll(".exercise-row")].map((row) => {
    const [exercise, points] = fieldsOf(row);
    return { exercise: exercise.value, points: Number(points.value) };
  });
  return chosen.filter(({ exercise }) => exercise);
}

/** @param {Element} row @returns {[HTMLSelectElement, HTMLInputElement]} */
function fieldsOf(row) {
  const exercise = row.querySelector("select");
  const points = row.querySelector("input");
  if (!exercise || !points) throw new Error("The row has no fields.");
  return [exercise, points];
}

// The storage key of the message about a form, which the page shows after its reload.
const TOLD = "dh-grader:told";

// The service takes 256 KiB and 20,000 commas at once. A character is up to three bytes; quotes are escaped.
const MOST = 60_000;
const MOST_COMMAS = 15_000;

/**
 * Return a class list in pieces that are short enough to be sent. Each piece begins with the headings, and has an
 * empty line for each line of earlier pieces, so that messages about the piece name the correct line.
 *
 * @param {string} csv
 */
export function pieces(csv) {
  /** @type {string[]} */
  const records = [];
  let isQuoted = false;
  for (const line of csv.trimStart().split("\n")) {
    if (isQuoted) records.push(`${records.pop()}\n${line}`);
    else records.push(line);
    if (line.split('"').length % 2 === 0) isQuoted = !isQuoted;
  }
  const [head, ...others] = records;
  const found = [head];
  let [size, commas] = [0, 0];
  for (const [i, record] of others.entries()) {
    const length = record.length + 1;
    const more = record.split(",").length;
    if (size && (size + length > MOST || commas + more > MOST_COMMAS)) {
      found.push(head + "\n".repeat(i));
      [size, commas] = [0, 0];
    }
    found.push(`${found.pop()}\n${record}`);
    size += length;
    commas += more;
  }
  return found;
}

/** @param {HTMLFormElement} form */
async function post(form) {
  const state = form.querySelector("[role=status]") ?? form.appendChild(h("p", { role: "status" }));
  const button = form.querySelector("button[type=submit]");
  if (!(state instanceof HTMLElement)) return;
  const body = bodyOf(form);
  const faults = faultsIn(body);
  if (faults) return tell(state, faults);
  button?.setAttribute("disabled", "");
  try {
    const lists = typeof body.csv === "string" ? pieces(body.csv).map((csv) => ({ ...body, csv })) : [body];
    const answers = [];
    for (const each of lists) answers.push(await send(form.dataset.post ?? "", each));
    if (form.dataset.done) return tell(state, form.dataset.done);
    if (form.dataset.then) location.assign(address(form.dataset.then + String(body.id)));
    else reload("learner" in body ? "" : doneBy(answers));
  } catch (error) {
    failed(error, state);
  } finally {
    button?.removeAttribute("disabled");
  }
}

/** Reload the page, which then shows what was done. @param {string} told */
function reload(told) {
  try {
    if (told) sessionStorage.setItem(TOLD, told);
  } catch {
    // Without storage, the page only shows the result.
  }
  location.reload();
}

/** After a reload, show at the top of the page what a form has done before. */
function tellDone() {
  try {
    const told = sessionStorage.getItem(TOLD);
    sessionStorage.removeItem(TOLD);
    if (!told) return;
    const place = h("p", { role: "status", class: "notice" });
    document.querySelector("h1")?.after(place);
    tell(place, told);
  } catch {
    // Without storage, there is nothing to say.
  }
}

/**
 * Propose the points that the exercise has in the catalogue.
 *
 * @param {Event} event
 */
function proposePoints({ target }) {
  if (!(target instanceof HTMLSelectElement) || !target.closest(".exercise-row")) return;
  const [, points] = fieldsOf(/** @type {Element} */ (target.parentElement));
  points.value = target.selectedOptions[0]?.dataset.points ?? "";
}

/**
 * Fill the other fields of the form with the values of the chosen option, which are in its data attributes. A request
 * replaces all of them, so a tutor must see the values that stay.
 *
 * @param {HTMLSelectElement} select
 */
function fillingFields(select) {
  const fill = () => {
    for (const field of select.form?.elements ?? []) {
      if (field instanceof HTMLInputElement) field.value = select.selectedOptions[0]?.dataset[field.name] ?? "";
    }
  };
  select.addEventListener("change", fill);
  fill();
}

/** @param {Element} list */
function growing(list) {
  list.addEventListener("change", proposePoints);
  const template = list.querySelector("template");
  const button = list.querySelector("[data-add]");
  button?.addEventListener("click", () => {
    const row = template?.content.firstElementChild?.cloneNode(true);
    if (!(row instanceof Element)) return;
    button.parentElement?.before(row);
    fieldsOf(row)[0].focus();
  });
}

/**
 * Return the text of a file in UTF-8, UTF-16, or, as Excel on Windows writes it, Windows-1252.
 *
 * @param {ArrayBuffer} data
 */
export function textOf(data) {
  const [first, second] = new Uint8Array(data);
  if (first === 0xff && second === 0xfe) return new TextDecoder("utf-16le").decode(data);
  if (first === 0xfe && second === 0xff) return new TextDecoder("utf-16be").decode(data);
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(data);
  } catch {
    return new TextDecoder("windows-1252").decode(data);
  }
}

/** @param {HTMLInputElement} input */
function filling(input) {
  whenChosen(input, async ([file]) => {
    const place = document.getElementById(input.dataset.fills ?? "");
    if (place instanceof HTMLTextAreaElement) place.value = textOf(await file.arrayBuffer());
  });
}

if (typeof document !== "undefined") {
  /** @type {NodeListOf<HTMLFormElement>} */
  const forms = document.querySelectorAll("form[data-post]");
  for (const form of forms) {
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      post(form);
    });
  }
  document.querySelectorAll("fieldset[data-list]").forEach(growing);
  /** @type {NodeListOf<HTMLSelectElement>} */
  const filled = document.querySelectorAll("select[data-fills-fields]");
  filled.forEach(fillingFields);
  /** @type {NodeListOf<HTMLInputElement>} */
  const files = document.querySelectorAll("input[data-fills]");
  files.forEach(filling);
  tellDone();
}
