// Typesets the names in a text: theta1 becomes θ with the index 1. service/dh_grader/typeset.py has the same rules and
// describes them; the cases in tests/typeset/names.json hold for both.

import { h, message } from "../shared/dom.js";

const MATHML = "http://www.w3.org/1998/Math/MathML";

/** @type {Record<string, string>} */
const GREEK = Object.fromEntries(
  ("alpha α beta β gamma γ delta δ epsilon ε zeta ζ eta η theta θ iota ι kappa κ lambda λ mu μ nu ν xi ξ rho ρ " +
    "sigma σ tau τ upsilon υ phi φ chi χ psi ψ omega ω pi π Gamma Γ Delta Δ Theta Θ Lambda Λ Xi Ξ Pi Π Sigma Σ " +
    "Phi Φ Psi Ψ Omega Ω").match(/\w+ ./g)?.map((each) => each.split(" ")) ?? [],
);
const LETTERS = Object.values(GREEK).join("");
const WORDS = new Set(["a", "A", "I", "delta", "iota"]);
const SPELLED = Object.keys(GREEK).filter((name) => name === name.toLowerCase() && !WORDS.has(name));
const INDEX = `[0-9A-Za-z${LETTERS}]+|\\{[^{}\\s]{1,8}\\}`;
const NAME = new RegExp(
  String.raw`[\p{L}\p{N}_]+://\S+` +
    String.raw`|(?<![\p{L}\p{N}_\\@#$'’}])(?:` +
    String.raw`(?<frame>\{[0-9A-Za-z](?:[\-−+]?[0-9])?\})` +
    `|(?<stem>[A-Za-z${LETTERS}]+)(?<digits>[0-9₀-₉]*)(?:_(?<below>${INDEX}))?(?:\\^(?<above>${INDEX}|\\*))?` +
    // In l’axe, the l is no symbol.
    String.raw`)(?![\p{L}\p{Nd}_]|[\{@]|['’]\p{L}{2})`,
  "gu",
);
// An axis by its letter, in each language: the x axis, die x-Achse, x 轴, l’axe x, el eje x.
const AXIS =
  /[xyz](?=[\s-]+(?:ax[ei]s|Achsen?)(?![A-Za-z])|\s?轴)|(?<=(?<![\p{L}\d_])(?:axes?|ejes?|Achse) )[xyz](?![\p{L}\d_'’])/uy;
const SIGN = new RegExp(
  String.raw`(?<![^\s(\[,;=])-(?=[0-9(${LETTERS}]|[A-Za-z][0-9_]|(?:${SPELLED.join("|")})(?![A-Za-z]))`,
  "gu",
);

/** @typedef {{ stem: string, below: string, above: string }} Name */

/**
 * Return a text in pieces: plain texts and `<math>` elements. `symbols` are the names that the exercise declares.
 *
 * @param {string} text
 * @param {Set<string>} [symbols]
 * @returns {(string | Element)[]}
 */
export function typeset(text, symbols = new Set()) {
  /** @type {(string | Element)[]} */
  const shown = pieces(text, symbols).map((piece) => typeof piece === "string" ? piece : make("math", element(piece)));
  for (let i = 0; i < shown.length; i++) {
    const formula = shown[i];
    if (!(formula instanceof Element)) continue;
    const [before, after] = [shown[i - 1], shown[i + 1]].map((each) => (typeof each === "string" ? each : ""));
    const opening = before.match(/[(\[−]*$/)?.[0] ?? "";
    const closing = after.match(/^[),.;:!?\]²³]*/)?.[0] ?? "";
    if (opening) shown[i - 1] = before.slice(0, -opening.length);
    if (closing) shown[i + 1] = after.slice(closing.length);
    if (opening || closing) shown[i] = h("span", { class: "maths" }, opening, formula, closing);
  }
  return shown;
}

/**
 * Return a message of the service like `message`, with its names typeset.
 *
 * @param {string} text
 * @param {Set<string>} [symbols]
 */
export function typesetMessage(text, symbols) {
  return message(text).flatMap((part) => (typeof part === "string" ? typeset(part, symbols) : [part]));
}

/** @param {string} name of a symbol */
export function symbolName(name) {
  const [piece, ...rest] = pieces(name, new Set([name]));
  return h("span", {}, typeof piece === "string" || rest.length ? name : make("math", element(piece)));
}

/**
 * Return the names in a text, and the texts between them.
 *
 * @param {string} text
 * @param {Set<string>} symbols
 * @returns {(string | Name)[]}
 */
export function pieces(text, symbols) {
  const shown = text.replace(SIGN, "−");
  const found = [];
  let done = 0;
  for (const match of shown.matchAll(NAME)) {
    const name = nameOf(match, symbols);
    if (!name) continue;
    if (match.index > done) found.push(shown.slice(done, match.index));
    found.push(name);
    done = match.index + match[0].length;
  }
  if (done < shown.length) found.push(shown.slice(done));
  return found;
}

/**
 * Return the name in a match, or null if the match is a word.
 *
 * @param {RegExpMatchArray} match
 * @param {Set<string>} symbols
 * @returns {Name | null}
 */
function nameOf(match, symbols) {
  const { frame, stem, digits = "", below: index = "", above: power = "" } = match.groups ?? {};
  if (frame) return { stem: frame.replace("-", "−"), below: "", above: "" };
  if (!stem) return null;
  const [below, above] = [index, power].map((each) => each.replace(/^\{|\}$/g, "").replace("-", "−"));
  const plain = digits.replace(/[₀-₉]/g, (digit) => String("₀₁₂₃₄₅₆₇₈₉".indexOf(digit)));
  const name = { stem, below: plain + below, above };
  const isLetter = stem.length === 1 && (name.below || above || LETTERS.includes(stem));
  const isGreek = SPELLED.includes(stem) || (Object.hasOwn(GREEK, stem) && name.below);
  AXIS.lastIndex = match.index ?? 0;
  const isAxis = !name.below && AXIS.test(match.input ?? "");
  if (isAxis || isLetter || isGreek || below.length === 1 || /^\d+$/.test(below)) return name;
  const written = match[0].split("^")[0];
  return symbols.has(written) && (!WORDS.has(written) || written === match.input) ? name : null;
}

/** @param {Name} name */
function element({ stem, below, above }) {
  if (stem.startsWith("{")) {
    const brace = (/** @type {string} */ sign) => make("mo", sign, { stretchy: "false" });
    return make("mrow", brace("{"), identifier(stem.slice(1, -1)), brace("}"));
  }
  const parts = [stem, below, above].filter(Boolean).map(identifier);
  const tag = below && above ? "msubsup" : below ? "msub" : "msup";
  return parts.length === 1 ? parts[0] : make(tag, ...parts);
}

/** @param {string} text */
function identifier(text) {
  const tag = /^\d+$/.test(text) ? "mn" : text === "*" ? "mo" : "mi";
  return make(tag, Object.hasOwn(GREEK, text) ? GREEK[text] : text);
}

/**
 * Return an element of MathML with children; an object among the arguments has the element's attributes.
 *
 * @param {string} tag
 * @param {...(string | Element | Record<string, string>)} parts
 */
function make(tag, ...parts) {
  const made = document.createElementNS(MATHML, tag);
  for (const part of parts) {
    if (typeof part === "string" || part instanceof Element) made.append(part);
    else for (const [name, value] of Object.entries(part)) made.setAttribute(name, value);
  }
  return made;
}
