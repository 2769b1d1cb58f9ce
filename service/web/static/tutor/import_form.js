// The form *New exercise from…* of the editor: a URDF file or a DH table becomes the text of an exercise file.

import { byId, h, visible, whenChosen } from "../shared/dom.js";
import { worded } from "../shared/words/words.js";
import { post, refusal } from "./tutor_service.js";

// The maximum number of characters that the page sends: less than the service takes, for other fields and escapes.
const MOST = 200_000;

/**
 * Return an exercise id made from a file's name, or "" if the name has no letters or digits.
 *
 * @param {string} name
 */
export function idOf(name) {
  const words = name.replace(/\.[^.]*$/u, "").toLowerCase().match(/[a-z0-9]+/gu) ?? [];
  return words.join("-").slice(0, 50);
}

/**
 * Let the form call `written` with the text of each new exercise. `named` takes a proposed id for the exercise, and
 * `id` returns the id in the editor.
 *
 * @param {{ id: () => string, named: (id: string) => void, written: (text: string) => void }} editor
 */
export function importForm({ id, named, written }) {
  const kind = byId("kind", HTMLSelectElement);
  const robot = byId("robot", HTMLTextAreaElement);
  const state = byId("imported", HTMLElement);
  const file = byId("robot-file", HTMLInputElement);
  /** @param {string} name */
  const value = (name) => byId(name, HTMLInputElement).value.trim();

  whenChosen(file, async ([chosen]) => {
    robot.value = await chosen.text();
    kind.value = /\.(urdf|xml)$/iu.test(chosen.name) ? "urdf" : "table";
    named(idOf(chosen.name));
  });

  async function make() {
    if (robot.value.length > MOST) {
      state.textContent = worded(
        "This file is too large for the browser. Use dh-grader exercises import on a command line.",
      );
      return;
    }
    const body = {
      kind: kind.value,
      text: robot.value,
      id: id(),
      title: value("robot-title"),
      tip: value("tip"),
      base: value("base"),
      letters: byId("letters", HTMLInputElement).checked && kind.value === "urdf",
      convention: byId("convention", HTMLSelectElement).value,
    };
    try {
      const { text, remarks } = await (await post("../tutor/import", JSON.stringify(body))).json();
      written(text);
      const all = [...remarks, worded("The exercise is in the editor. Read its statement, then save it.")];
      state.replaceChildren(...all.flatMap((each) => [visible(each), h("br")]));
    } catch (error) {
      state.textContent = refusal(error);
    }
  }

  kind.form?.addEventListener("submit", (event) => {
    event.preventDefault();
    make();
  });
}
