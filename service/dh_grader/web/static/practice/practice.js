// The page of generated robots. The address names the robot, so it can be shared, and Back leads to the last robot.

import { robotOf } from "../student/practice/robot_ids.js";

const element = document.querySelector("dh-exercise");

// The last address that this script has followed or written.
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
