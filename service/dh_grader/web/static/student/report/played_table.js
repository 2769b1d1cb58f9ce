// The 3D view of a recorded table, in which its rows can be played.

import { h } from "../../shared/dom.js";
import { answersToDraw, tableWords } from "../robot_figure.js";
import { loadRobotView, NOT_LOADED } from "../../robot/view_loader.js";
import { worded } from "../../shared/words/words.js";

/**
 * Return a button that opens the 3D view of the table in a part, and the place of the view.
 *
 * @param {Api.Exercise} exercise
 * @param {Front.PartView} part
 * @param {Front.PartHost} host
 */
export function playedTable(exercise, part, host) {
  /** @type {Front.RobotView | null} */
  let view = null;
  const told = h("p", { class: "quiet", role: "status" });
  const say = (/** @type {string} */ text) => {
    told.textContent = text;
  };
  const button = h(
    "button",
    { type: "button", class: "quiet-button", "aria-expanded": "false" },
    worded("Play this table in 3D"),
  );
  const toggle = async () => {
    if (view) {
      view.close();
      view.element.remove();
      view = null;
    } else {
      const RobotView = await loadRobotView();
      say("");
      view = new RobotView({
        service: /** @type {Front.Service} */ (/** @type {unknown} */ (host.service)),
        body: () => ({ ...host.context(), ...answersToDraw([part]) }),
        ...tableWords(exercise.symbols, () => [part]),
        announce: say,
      });
      place.append(view.element);
      view.open();
    }
    button.setAttribute("aria-expanded", String(view !== null));
  };
  button.onclick = () => toggle().catch(() => say(NOT_LOADED));
  const place = h("div", { class: "played-table" }, button, told);
  return place;
}
