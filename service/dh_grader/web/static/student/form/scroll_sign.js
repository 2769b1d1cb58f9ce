// A sign at the edge of an area that scrolls sideways: if more is hidden there, the content fades out below an arrow.

import { h } from "../../shared/dom.js";

// The least number of hidden pixels; fewer pixels are rounding or padding.
const LEAST = 6;

/**
 * Add the signs to a scrolling element with one child. While the element scrolls, each sign stays at its edge.
 *
 * @template {HTMLElement} Scrolling
 * @param {Scrolling} element
 */
export function withScrollSign(element) {
  const [before, after] = ["before", "after"].map((side) => h("span", { class: `more ${side}`, hidden: true }));
  const update = () => {
    const { scrollLeft, scrollWidth, clientWidth } = element;
    before.hidden = Math.abs(scrollLeft) <= LEAST;
    after.hidden = scrollWidth - clientWidth - Math.abs(scrollLeft) <= LEAST;
  };
  element.addEventListener("scroll", update, { passive: true });
  const sizes = new ResizeObserver(update);
  for (const each of [element, ...element.children]) sizes.observe(each);
  element.classList.add("with-sign");
  element.append(before, after);
  return element;
}
