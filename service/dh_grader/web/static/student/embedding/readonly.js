// Read-only answers: students can move through the cells and read them, but not change them.

const CHANGES = ["paste", "beforeinput", "drop"];

/** @param {Event} event */
function refuse(event) {
  event.preventDefault();
  event.stopPropagation();
}

/**
 * Let the student change the answers, or only read them.
 *
 * @param {HTMLElement} exercise
 * @param {{ cells: Front.PartCell[], choice: HTMLSelectElement | null, marks: Front.SlipMarks | null }[]} parts
 * @param {boolean} isReadOnly
 */
export function lock(exercise, parts, isReadOnly) {
  exercise.classList.toggle("read-only", isReadOnly);
  // The listeners capture the events, so that the cells do not get them.
  for (const name of CHANGES) {
    if (isReadOnly) exercise.addEventListener(name, refuse, true);
    else exercise.removeEventListener(name, refuse, true);
  }
  if (!isReadOnly) return;
  for (const { cells, choice, marks } of parts) {
    for (const { input } of cells) input.readOnly = true;
    if (choice) choice.disabled = true;
    marks?.lock();
  }
}
