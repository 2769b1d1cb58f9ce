// The search of the catalogue: which exercises have all words of a query.

// "6 DOF", "6-axis" and "6 degrees of freedom" mean the same.
const JOINTS = /(\d+)[\s-]*(?:dofs?|d\.o\.f\.?|degrees? of freedom|axis|axes|joints?)(?![a-z])/g;
const ACCENTS = /\p{Mn}/gu;
const SHORT = 2;

/**
 * Return the words of a text in lower case, without accents; "6 degrees of freedom" becomes "6dof".
 *
 * @param {string} text
 */
export function wordsOf(text) {
  const plain = text.normalize("NFKD").replace(ACCENTS, "").toLowerCase();
  return plain.replace(JOINTS, "$1dof").split(/[\s,;:()"$]+/).filter(Boolean);
}

/**
 * Return true if the text has all words of the query. A word of one or two characters must begin a word of the text,
 * longer ones may be anywhere in it.
 *
 * @param {string[]} words of the text
 * @param {string} query
 */
export function matches(words, query) {
  return wordsOf(query).every((wanted) =>
    words.some((word) => (wanted.length > SHORT ? word.includes(wanted) : word.startsWith(wanted)))
  );
}
