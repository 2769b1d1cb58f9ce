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
  const questions = byId("questions", HTMLFieldSetElement);
  /** @param {string} name */
  const value = (name) => byId(name, HTMLInputElement).value.trim();

  /** @type {Map<string, HTMLSelectElement>} */
  const answers = new Map();

  function forget() {
    answers.clear();
    questions.querySelectorAll("label, select").forEach((each) => each.remove());
    questions.hidden = true;
  }

  /** @param {{ name: string, text: string, choices: string[] }[]} asked */
  function ask(asked) {
    /** @type {Record<string, string>} */
    const shown = {
      degrees: worded("degrees"),
      radians: worded("radians"),
      standard: worded("standard"),
      modified: worded("modified"),
    };
    for (const { name, text, choices } of asked) {
      const options = choices.map((each) => h("option", { value: each }, shown[each] ?? each));
      const field = h(
        "select",
        { id: `question-${name}`, required: true },
        h("option", { value: "" }, "…"),
        ...options,
      );
      answers.set(name, field);
      questions.append(h("label", { for: field.id }, visible(text)), field);
    }
    questions.hidden = false;
    answers.get(asked[0].name)?.focus();
  }

  robot.addEventListener("input", forget);

  whenChosen(file, async ([chosen]) => {
    forget();
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
      convention: byId("convention", HTMLSelectElement).value || null,
      ...Object.fromEntries([...answers].map(([name, field]) => [name, field.value])),
    };
    try {
      const { text, remarks, questions: asked } = await (await post("../tutor/import", JSON.stringify(body))).json();
      if (asked.length > 0) {
        ask(asked);
        state.textContent = worded("Answer the questions above, then make the exercise.");
        return;
      }
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
