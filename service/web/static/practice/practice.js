// The page of generated robots: the address has the robot, so that it can be shared and Back leads to the last one.

import { robotOf } from "../student/practice/robot_ids.js";

const element = document.querySelector("dh-exercise");

// The address that was last followed or written.
let known = "";

/** Show the robot that the address names. */
function follow() {
  known = location.hash;
  const id = location.hash.slice(1);
  if (robotOf(id)) element?.setAttribute("exercise", id);
}

follow();
addEventListener("hashchange", follow);
element?.addEventListener("ready", () => {
  const id = element.getAttribute("exercise");
  // Another address is not followed yet: Back was pressed while this robot was loading.
  if (!id || location.hash !== known || known === `#${id}`) return;
  if (known) location.hash = id;
  else history.replaceState(null, "", `#${id}`);
  known = location.hash;
});
