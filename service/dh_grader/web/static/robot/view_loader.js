// Loads the 3D view when a student opens it.

import { later } from "../shared/later.js";
import { worded } from "../shared/words/words.js";

/** The sentence for the student if the view did not arrive. */
export const NOT_LOADED = worded("The 3D view could not be loaded. Check your connection, then try again.");

/** Return the class RobotView. Throws an Error if its scripts do not arrive; the next call tries again. */
export async function loadRobotView() {
  const load = () => import("./robot_view.js");
  return (await later(import.meta.resolve("./robot_view.js"), load)).RobotView;
}
