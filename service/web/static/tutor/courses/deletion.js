// Deletions on the pages of courses: first the service says what would go, then a second button deletes it.

import { h } from "../../shared/dom.js";
import { count, failed, tell } from "../records/records.js";
import { address, send } from "../tutor_service.js";

/**
 * Return what a deletion deletes, in words.
 *
 * @param {Api.DeletedData} data
 */
export function inWords({ assignments, learners, extensions, keys, attempts }) {
  const told = [
    assignments && count(assignments, "assignment"),
    learners && `the place of ${count(learners, "learner")}`,
    extensions && count(extensions, "extension"),
    keys && count(keys, "link"),
    attempts && `${count(attempts, "attempt")} with answers and reports`,
  ];
  return told.filter(Boolean).join(", ") || "nothing else";
}

/** @param {HTMLElement} place */
function offer(place) {
  const { delete: path = "", learner, what = "", then = "" } = place.dataset;
  // The attempts of a removed learner stay, and count again if the learner comes back.
  const keepsAttempts = learner !== undefined;
  const body = learner === undefined ? {} : { learner };
  const state = h("p", { role: "status", class: "state-line" });
  const ask = h("button", { type: "button", onclick: preview }, `Delete ${what} …`);
  const final = h("button", { type: "button", class: "danger", onclick: remove }, "Delete permanently");
  const cancel = h("button", { type: "button", onclick: () => shown(false) }, "Cancel");
  let withAttempts = false;

  /** @param {boolean} isAsked */
  function shown(isAsked) {
    ask.hidden = isAsked;
    final.hidden = cancel.hidden = !isAsked;
    if (!isAsked) tell(state, "");
    (isAsked ? cancel : ask).focus();
  }

  async function preview() {
    try {
      const found = await send(path, body);
      withAttempts = found.attempts > 0 && !keepsAttempts;
      shown(true);
      const kept = keepsAttempts ? ` ${count(found.attempts, "attempt")} of this learner will stay.` : "";
      const gone = inWords(keepsAttempts ? { ...found, attempts: 0 } : found);
      tell(state, `This deletes ${what}: ${gone}. It cannot be undone.${kept}`);
    } catch (error) {
      failed(error, state);
    }
  }

  async function remove() {
    try {
      await send(path, { ...body, apply: true, with_attempts: withAttempts });
      location.assign(address(then));
    } catch (error) {
      failed(error, state);
    }
  }

  final.hidden = cancel.hidden = true;
  place.append(h("p", { class: "choices" }, ask, final, cancel), state);
}

if (typeof document !== "undefined") {
  for (const place of document.querySelectorAll("[data-delete]")) if (place instanceof HTMLElement) offer(place);
}
