// The learner's page: it takes the key out of the personal link, and shows the assignments and their exercises.

import { byId, h, visible } from "../shared/dom.js";
import { Service } from "../shared/service.js";
import { ownState } from "../student/handin/own_state.js";
import { back, form, handedIn, report, solution } from "./assigned.js";
import { forgetKey, placeIn, takeKey, takePageKey } from "./link_key.js";
import { MISSING, overview } from "./overview.js";
import { worded } from "../shared/words/words.js";

const HOME = new URL("../", import.meta.url).href;
const main = byId("learner", HTMLElement);
const isLaunched = takePageKey();
let key = takeKey();
let turn = 0;
const service = new Service(HOME, () => key);

/** Load the learner's present state, and show the page that the address names. */
async function show() {
  key = takeKey();
  const now = ++turn;
  if (!key) {
    return advise(worded("Open your personal link"), worded("You got it from your lecturer, for example by e-mail."));
  }
  const place = placeIn(location.hash);
  try {
    const view = await service.own();
    const shown = place ? await exercise(view, place) : overview(view);
    if (now === turn) put(...shown, ...(isLaunched ? [] : [h("p", { class: "leave" }, signOut())]));
  } catch (error) {
    if (now === turn) failed(error);
  }
  return undefined;
}

/** @param {Error & { status?: number }} error */
function failed(error) {
  if ((error.status === 401 || error.status === 403) && isLaunched) {
    const told = worded("Open it again from your course. What you have handed in is not lost.");
    return advise(worded("The page was open for too long"), told);
  }
  if (error.status === 401 || error.status === 403) {
    const told = worded(
      "It has expired, or was replaced by a newer one. Use the newest link that you got, or ask your lecturer for a new one. What you have handed in is not lost.",
    );
    return advise(worded("This link is not valid any more"), told);
  }
  return put(
    h("h1", {}, worded("Your assignments could not be loaded")),
    h("p", { role: "alert" }, visible(error.message)),
    h("button", { type: "button", class: "quiet-button", onclick: show }, worded("Try again")),
  );
}

/** @param {Api.OwnCourses} view @param {Front.Assigned} place */
async function exercise(view, place) {
  const own = ownState(view, place.path, place.exercise);
  if (!own) return [back(), h("h1", {}, worded("This is not one of your assignments"))];
  if (own.exercise.is_missing && !place.attempt) {
    return [back(), h("h1", {}, visible(own.exercise.title)), h("p", { class: "lead" }, MISSING)];
  }
  if (place.attempt) return [back(), ...await report(service, place, own)];
  const { element, done } = form(place, key);
  let latest = own;
  const showSolution = async () => {
    try {
      done.replaceChildren(...await solution(service, place, latest));
      done.querySelector("h2")?.focus();
    } catch (error) {
      done.append(h("p", { role: "alert" }, visible(error.message)));
    }
  };
  const list = (/** @type {Front.Own} */ now) => {
    latest = now;
    done.replaceChildren(...handedIn(now, place, showSolution).filter((each) => each !== null));
  };
  list(own);
  element.addEventListener("submitted", async () => {
    const now = ownState(await service.own(), place.path, place.exercise);
    if (now) list(now);
  });
  return [back(), element, done];
}

function signOut() {
  const leave = () => {
    // A page that is still loading must not appear after the learner has signed out.
    turn++;
    forgetKey();
    history.replaceState(null, "", location.pathname);
    key = "";
    advise(worded("You are signed out"), worded("Open your personal link to come back."));
  };
  return h("button", { type: "button", class: "quiet-button", onclick: leave }, worded("Sign out"));
}

/** @param {string} title @param {string} text */
function advise(title, text) {
  put(h("h1", {}, title), h("p", { class: "lead" }, text));
}

/** @param {...Node} shown */
function put(...shown) {
  main.removeAttribute("aria-busy");
  main.replaceChildren(...shown);
  const title = main.querySelector("h1")?.textContent;
  document.title = title ? `${title} · DH Grader` : `${worded("My assignments")} · DH Grader`;
}

addEventListener("hashchange", async () => {
  await show();
  scrollTo(0, 0);
  main.focus({ preventScroll: true });
});
show();
