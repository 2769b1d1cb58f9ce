// Marks to click for the current frame: joint axes for z, dots for the origin, and arrows for x. They are drawn over
// the canvas, which gets the clicks.

const SVG = "http://www.w3.org/2000/svg";
// The width of a finger, in pixels.
export const FINGER = 44;

export class Marks {
  /** @param {HTMLElement} stage */
  constructor(stage) {
    this.element = svg("svg", { class: "place-marks", "aria-hidden": "true" });
    stage.append(this.element);
    /** @type {Front.PlaceMark[]} */
    this.shown = [];
  }

  /** @param {Front.PlaceMark[]} marks @param {Front.AxisMark[]} axes */
  show(marks, axes) {
    this.shown = marks;
    this.element.replaceChildren(
      ...axes.map(({ joint, ends: [[x1, y1], [x2, y2]] }) => svg("line", { class: "axis", x1, y1, x2, y2 }, joint)),
      ...marks.map(({ at: [cx, cy], from, texts, isChosen }) =>
        svg("g", { class: isChosen ? "chosen" : "" }, texts.map(([, text]) => text).join(", "), [
          ...(from ? [svg("line", { x1: from[0], y1: from[1], x2: cx, y2: cy })] : []),
          svg("circle", { cx, cy, r: from ? 5 : 7 }),
        ])
      ),
    );
  }

  /**
   * Return the nearest mark at a place of the stage; undefined if none is near.
   *
   * @param {number[]} at
   */
  nearest(at) {
    const far = (/** @type {Front.PlaceMark} */ mark) => Math.hypot(mark.at[0] - at[0], mark.at[1] - at[1]);
    return this.shown.filter((mark) => far(mark) <= FINGER / 2).sort((one, other) => far(one) - far(other))[0];
  }

  close() {
    this.element.remove();
  }
}

/**
 * Return an element; `value` is what a click on it writes.
 *
 * @param {string} tag
 * @param {Record<string, string | number>} attributes
 * @param {string} [value]
 * @param {Element[]} [children]
 */
function svg(tag, attributes, value, children = []) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, text] of Object.entries(attributes)) element.setAttribute(name, String(text));
  if (value !== undefined) element.dataset.value = value;
  element.append(...children);
  return element;
}
