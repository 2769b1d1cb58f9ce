// The page of generated robots: the address has the robot, so that it can be shared and Back leads to the last one.

import { robotOf } from "../student/practice/robot_ids.js";

const element = document.querySelector("dh-exercise");

/** Show the robot that the address names. */
function follow() {
  const id = location.hash.slice(1);
  if (robotOf(id)) element?.setAttribute("exercise", id);
}

follow();
addEventListener("hashchange", follow);
element?.addEventListener("ready", () => {
  const id = element.getAttribute("exercise");
  if (!id || location.hash === `#${id}`) return;
  if (location.hash) location.hash = id;
  else history.replaceState(null, "", `#${id}`);
});
