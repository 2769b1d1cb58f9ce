// Markup from the service: MathML and statements. It is parsed without running scripts, and only known
// elements are copied. An unknown element is replaced by its content.

const MATHML = "http://www.w3.org/1998/Math/MathML";
const XHTML = "http://www.w3.org/1999/xhtml";

const MATHML_TAGS = new Set(
  ("math mrow mi mn mo ms mtext mspace msup msub msubsup mfrac msqrt mroot mtable mtr mtd mover munder " +
    "munderover mstyle mpadded mphantom semantics").split(" "),
);
const XHTML_TAGS = new Set(
  "p ul ol li em strong b i code pre br hr blockquote table thead tbody tr th td h2 h3 h4 h5 h6 sub sup dl dt dd div span"
    .split(" "),
);
const DROPPED = new Set(["annotation", "annotation-xml", "script", "style", "template", "iframe", "object"]);
const ATTRIBUTES = new Set(
  ("mathvariant width height depth display stretchy fence separator lspace rspace minsize maxsize linethickness " +
    "columnalign scope start colspan rowspan").split(" "),
);

const CLASSES = new Set(["display", "maths", "matrix"]);

/** @type {{ createHTML(text: string): string } | undefined} */
const policy = /** @type {any} */ (globalThis).trustedTypes?.createPolicy("dh-grader", {
  createHTML: (/** @type {string} */ text) => text,
});

/** @param {string} text @param {DOMParserSupportedType} type */
function parsed(text, type) {
  return new DOMParser().parseFromString(policy ? policy.createHTML(text) : text, type);
}

/** @param {Node} node @returns {Node | null} */
function copied(node) {
  if (node.nodeType === Node.TEXT_NODE) return document.createTextNode(node.nodeValue ?? "");
  if (!(node instanceof Element) || DROPPED.has(node.localName)) return null;
  const children = [...node.childNodes].map(copied).filter((child) => child !== null);
  const tags = node.namespaceURI === MATHML ? MATHML_TAGS : node.namespaceURI === XHTML ? XHTML_TAGS : null;
  if (!tags?.has(node.localName)) {
    const fragment = document.createDocumentFragment();
    fragment.append(...children);
    return fragment;
  }
  const element = document.createElementNS(node.namespaceURI, node.localName);
  for (const { name, value } of node.attributes) if (ATTRIBUTES.has(name)) element.setAttribute(name, value);
  element.classList.add(...[...node.classList].filter((name) => CLASSES.has(name)));
  element.append(...children);
  return element;
}

/**
 * Return the `<math>` element of the text, or null if the text is something else.
 *
 * @param {string | undefined} text
 */
export function mathml(text) {
  const root = text ? parsed(text, "application/xml").documentElement : null;
  return root?.namespaceURI === MATHML && root.localName === "math" ? copied(root) : null;
}

/**
 * Return a page of the service as a document. Show it only under a policy that blocks scripts.
 *
 * @param {string} text
 */
export function documentOf(text) {
  return parsed(text, "text/html");
}

/**
 * Return the statement of an exercise as nodes.
 *
 * @param {string} text
 */
export function html(text) {
  return [...parsed(text, "text/html").body.childNodes].map(copied).filter((node) => node !== null);
}

/**
 * Return a matrix of formulas; each is given as the text of a `<math>` element.
 *
 * @param {string[][]} rows
 */
export function matrix(rows) {
  /** @type {(tag: string, ...children: Node[]) => Element} */
  const make = (tag, ...children) => {
    const element = document.createElementNS(MATHML, tag);
    element.append(...children);
    return element;
  };
  /** @type {(text: string) => Element} */
  const entry = (text) => make("mtd", ...(mathml(text)?.childNodes ?? []));
  const table = make("mtable", ...rows.map((row) => make("mtr", ...row.map(entry))));
  // The style sheet draws the brackets, because not every system has a font with brackets that grow.
  return make("math", table);
}
