// Creates elements. No element is made from a string, so the texts of students and files are never markup.

/**
 * Return an element with attributes, listeners and children; a child that is null or false is left out.
 *
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Front.Attributes} attributes
 * @param {...(Front.Child | Front.Child[])} children
 */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/**
 * Return the element of the page with this id. Throws an Error if it is missing or of another class.
 *
 * @template {HTMLElement} Kind
 * @param {string} id
 * @param {abstract new (...args: never) => Kind} kind
 */
export function byId(id, kind) {
  const element = document.getElementById(id);
  if (!(element instanceof kind)) throw new Error(`The page has no ${kind.name} with the id ${id}.`);
  return element;
}

/**
 * Call `use` when the user chooses files, and at once if the user chose them before this script ran.
 *
 * @param {HTMLInputElement} input
 * @param {(files: File[]) => void} use
 */
export function whenChosen(input, use) {
  const chosen = () => {
    if (input.files?.length) use([...input.files]);
  };
  input.addEventListener("change", chosen);
  chosen();
}

// Characters that are invisible, or that change the direction of the text.
const UNSEEN = /[\p{Cc}\p{Cf}\p{Co}\p{Cn}\u2028\u2029]/gu;

/**
 * Return the text with every invisible character replaced by its code point, such as [U+202E].
 *
 * @param {unknown} text
 */
export function visible(text) {
  return String(text).replace(
    UNSEEN,
    (character) =>
      character === "\n" || character === "\t"
        ? " "
        : `[U+${Number(character.codePointAt(0)).toString(16).toUpperCase().padStart(4, "0")}]`,
  );
}

/**
 * Return a message of the service as nodes and texts; text between two backticks is code.
 *
 * @param {string} text
 */
export function message(text) {
  const pieces = visible(text).split("`");
  if (pieces.length % 2 === 0) return [pieces.join("`")];
  return pieces.map((piece, i) => (i % 2 ? h("code", {}, piece) : piece));
}

/**
 * Return a number with at most two decimals.
 *
 * @param {number} value
 */
export function number(value) {
  return String(Math.round(value * 100) / 100);
}

/**
 * Return points such as "1.5 / 2"; they are never rounded up to full marks.
 *
 * @param {number} earned
 * @param {number} most
 */
export function points(earned, most) {
  const shown = earned < most && number(earned) === number(most) ? Math.floor(earned * 100) / 100 : earned;
  return `${number(shown)} / ${number(most)}`;
}

/**
 * Return three decimals, without a negative zero.
 *
 * @param {number} value
 */
export function decimal(value) {
  return (Math.round(value * 1000) / 1000 + 0).toFixed(3).replace(/^-(0\.000)$/, "$1");
}
