// Scripts that a page loads only when it needs them.
//
// A browser never requests a module again after a request for it has failed, not even if another module imports it. So
// this file fetches a script and everything that it imports before the import. A fetch can be tried again, and the import
// takes the files from the browser's cache.

// An import at the beginning of a module, with or without names; not `import(…)`.
const IMPORTED = /\b(?:from|import)\s*"(\.[^"]+\.js)"/g;

/** The addresses that each script imports. @type {Map<string, Promise<string[]>>} */
const IMPORTS = new Map();

/**
 * Return a module that `load` imports from an address. After an error, it can be loaded again.
 *
 * @template Module
 * @param {string} address
 * @param {() => Promise<Module>} load
 */
export async function later(address, load) {
  await fetchAll(address);
  return load();
}

/** Fetch a script and all scripts that it imports. Throws an Error if one of them does not arrive. @param {string} first */
async function fetchAll(first) {
  // The page has these scripts already.
  const links = /** @type {NodeListOf<HTMLLinkElement>} */ (document.querySelectorAll('link[rel="modulepreload"]'));
  const seen = new Set([...links].map(({ href }) => href));
  let waiting = [first];
  while (waiting.length) {
    for (const each of waiting) seen.add(each);
    const named = await Promise.all(waiting.map(importsOf));
    waiting = [...new Set(named.flat())].filter((each) => !seen.has(each));
  }
}

/** @param {string} address */
function importsOf(address) {
  const known = IMPORTS.get(address);
  if (known) return known;
  const found = fetchedImports(address);
  IMPORTS.set(address, found);
  found.catch(() => IMPORTS.delete(address));
  return found;
}

/** @param {string} address */
async function fetchedImports(address) {
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
  const text = await answer.text();
  return [...text.matchAll(IMPORTED)].map(([, path]) => new URL(path, address).href);
}
