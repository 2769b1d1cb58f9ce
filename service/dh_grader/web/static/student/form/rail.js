// The rail of an exercise: the progress of each part, as in "Table ✓ · Links 2/6 · Pose". A click leads to the part.

import { h } from "../../shared/dom.js";
import { SIGNS } from "../../shared/cell.js";
import { verdictName } from "../../shared/words/phrases.js";
import { worded } from "../../shared/words/words.js";

/** @type {Record<string, string>} */
const SHORT = {
  dh_table: worded("Table"),
  dh_row: worded("Row"),
  frames: worded("Frames"),
  find_slip: worded("Slip"),
  link_transforms: worded("Links"),
  transform: worded("Pose"),
  rotation: worded("Rotation"),
  position: worded("Position"),
  euler_angles: worded("Angles"),
  screw_axes: worded("Screws"),
};

/**
 * Return a short name for each part: the name of its kind, or the title of the part if several parts have this kind.
 *
 * @param {Pick<Api.Part, "kind" | "title">[]} parts
 */
export function shortNames(parts) {
  const kinds = parts.map(({ kind }) => kind);
  return parts.map(({ kind, title }) =>
    kinds.filter((each) => each === kind).length === 1 ? (SHORT[kind] ?? title) : title
  );
}

export class Rail {
  /** @type {HTMLElement[]} */
  #states;

  /** @param {Front.RailPart[]} parts */
  constructor(parts) {
    this.parts = parts;
    this.#states = parts.map(() => h("span", { class: "mark" }));
    const names = shortNames(parts.map(({ part }) => part));
    const steps = parts.map((part, i) =>
      h("li", {}, h("button", { type: "button", onclick: () => part.jump() }, h("span", {}, names[i]), this.#states[i]))
    );
    this.element = h(
      "nav",
      { class: "rail", "aria-label": worded("Parts"), hidden: parts.length < 2 },
      h("ol", {}, ...steps),
    );
  }

  update() {
    this.parts.forEach((part, i) => {
      const { verdict, done, of } = part.progress;
      const state = this.#states[i];
      const shown = verdict ? SIGNS[verdict] : done ? `${done}/${of}` : "";
      const said = verdict ? verdictName(verdict) : done ? worded("{done} of {all} filled", { done, all: of }) : "";
      if (state.dataset.said === said) return;
      state.dataset.said = said;
      if (verdict) state.dataset.verdict = verdict;
      else delete state.dataset.verdict;
      state.replaceChildren(
        ...(shown ? [h("span", { "aria-hidden": "true" }, shown), h("span", { class: "aloud" }, said)] : []),
      );
    });
  }
}
