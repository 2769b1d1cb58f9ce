// The sentences of the scripts in the language of the reader.
//
// A sentence is written in English. `{name}` is the place of a value, and a brace in the text is doubled. The service
// makes the dictionaries of all other languages from its catalogues; English needs none.

/** The files with the dictionaries, by language; the service writes them here. @type {Record<string, string>} */
const FILES = {};

/** Return the language of the exercise element on this page, or else the language of the page. */
function wanted() {
  const element = globalThis.document?.querySelector("dh-exercise");
  const near = element?.closest("[lang]") ?? globalThis.document?.documentElement;
  return element?.getAttribute("locale") || near?.getAttribute("lang") || "en";
}

/** @param {string} tag @returns {Promise<Front.Dictionary | null>} */
async function loaded(tag) {
  const file = FILES[tag.split(/[-_]/)[0].toLowerCase()];
  if (!file) return null;
  try {
    return (await import(file)).default;
  } catch {
    // The words stay English.
    return null;
  }
}

const dictionary = await loaded(wanted());

/** The language of all texts that scripts show, as a tag such as "de". */
export const language = dictionary?.tag ?? "en";

const rules = new Intl.PluralRules(dictionary?.tag ?? "en");

/**
 * Return a sentence in the reader's language, with its values.
 *
 * @param {string} text
 * @param {Front.WordedValues} [values]
 */
export function worded(text, values = {}) {
  return filled(dictionary?.words[text] ?? text, values);
}

/**
 * Return the sentence for a count, `one` or `many`, in the reader's language; `{count}` is the place of the count.
 *
 * @param {string} one
 * @param {string} many
 * @param {number} count
 * @param {Front.WordedValues} [values]
 */
export function wordedFor(one, many, count, values = {}) {
  const [single, several] = dictionary?.counts[one] ?? [one, many];
  return filled(rules.select(count) === "one" ? single : several, { count, ...values });
}

/**
 * Return a text in pieces, in which elements replace placeholders such as `{link}`.
 *
 * @template Piece
 * @param {string} text
 * @param {Record<string, Piece | Piece[]>} pieces
 * @returns {(string | Piece)[]}
 */
export function placed(text, pieces) {
  return text.split(/(\{\w+\})/).flatMap((part) => {
    const name = part.slice(1, -1);
    return part.startsWith("{") && Object.hasOwn(pieces, name) ? pieces[name] : part;
  });
}

/** @param {string} text @param {Front.WordedValues} values */
function filled(text, values) {
  return text.replace(/\{\{|\}\}|\{(\w+)\}/g, (place, name) => {
    if (!name) return place[0];
    return Object.hasOwn(values, name) ? String(values[name]) : place;
  });
}
