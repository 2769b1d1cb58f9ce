// The robots to start free play with, as tables in the standard convention.

import { worded } from "../shared/words/words.js";

/** @type {(a: string, alpha: string, d: string, theta: string) => Front.PlayRow} */
const R = (a, alpha, d, theta) => ({ kind: "R", cells: [a, alpha, d, theta] });
/** @type {(a: string, alpha: string, d: string, theta: string) => Front.PlayRow} */
const P = (a, alpha, d, theta) => ({ kind: "P", cells: [a, alpha, d, theta] });
/** @param {...Front.PlayRow} rows @returns {Front.Robot} */
const robot = (...rows) => ({ convention: "standard", unit: "radians", rows });

/** @type {Record<string, Front.Robot>} */
export const ROBOTS = {
  [worded("Planar arm, RR")]: robot(R("a1", "0", "0", "theta1"), R("a2", "0", "0", "theta2")),
  [worded("SCARA, RRPR")]: robot(
    R("a1", "0", "d1", "theta1"),
    R("a2", "pi", "0", "theta2"),
    P("0", "0", "d3", "0"),
    R("0", "0", "d4", "theta4"),
  ),
  [worded("Cylindrical arm, RPP")]: robot(
    R("0", "0", "d1", "theta1"),
    P("0", "-pi/2", "d2", "0"),
    P("0", "0", "d3", "0"),
  ),
  [worded("Stanford arm, RRPRRR")]: robot(
    R("0", "-pi/2", "0", "theta1"),
    R("0", "pi/2", "d2", "theta2"),
    P("0", "0", "d3", "0"),
    R("0", "-pi/2", "0", "theta4"),
    R("0", "pi/2", "0", "theta5"),
    R("0", "0", "d6", "theta6"),
  ),
  [worded("Elbow arm with a wrist, 6R")]: robot(
    R("0", "pi/2", "d1", "theta1"),
    R("a2", "0", "0", "theta2 + pi/2"),
    R("0", "pi/2", "0", "theta3 + pi/2"),
    R("0", "-pi/2", "d4", "theta4"),
    R("0", "pi/2", "0", "theta5"),
    R("0", "0", "d6", "theta6"),
  ),
  [worded("Redundant arm, 7R")]: robot(
    R("0", "-pi/2", "0.34", "theta1"),
    R("0", "pi/2", "0", "theta2"),
    R("0", "pi/2", "0.4", "theta3"),
    R("0", "-pi/2", "0", "theta4"),
    R("0", "-pi/2", "0.4", "theta5"),
    R("0", "pi/2", "0", "theta6"),
    R("0", "0", "0.15", "theta7"),
  ),
};
