// The one script that a course site loads: it defines <dh-exercise>.

import { DhExercise } from "./exercise_element.js";

if (!customElements.get("dh-exercise")) customElements.define("dh-exercise", DhExercise);
