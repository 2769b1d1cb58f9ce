// The page "DH in ten minutes": one screen at a time, a switch between the conventions, and the progress.

import { byId, h } from "../shared/dom.js";
import { Service } from "../shared/service.js";
import { ArmPicture } from "./arm_picture.js";
import { keepProgress, keptProgress } from "./progress_kept.js";
import { Question } from "./question.js";
import { SpaceView } from "./space_view.js";
import { ARM } from "./tour_robot.js";
import { typeset } from "../typeset/names.js";
import { worded } from "../shared/words/words.js";

const HOME = new URL("../", import.meta.url).href;
const LAST = "table";
const NAMES = ["a", "α", "d", "θ"];
/** @type {Record<Api.Convention, string>} */
const CONVENTIONS = { standard: worded("Standard (distal)"), modified: worded("Modified (proximal)") };

const main = byId("main", HTMLElement);
const tour = byId("tour", HTMLElement);
const service = new Service(HOME);
const screens = /** @type {HTMLElement[]} */ ([...main.querySelectorAll(".screen")]);
const progress = keptProgress();
const asked = new URLSearchParams(location.search).get("convention");
if (asked === "standard" || asked === "modified") progress.convention = asked;

/** @param {string} id */
const key = (id) => `${progress.convention}/${id}`;

// The form of the last screen: the table, in which only the last row can be written.
const form = h("form", { class: "question", "data-cell": LAST });
byId("rows", HTMLElement).append(form);
const space = new SpaceView(service, (text) => (space.told.textContent = text));
byId(LAST, HTMLElement).querySelector(".idea")?.append(space.element);

/** Write the table of the last screen in the current convention. */
function writeTable() {
  const { labels, texts } = ARM[progress.convention];
  const before = progress.convention === "modified" ? "i−1" : "i";
  const heads = NAMES.map((name, i) => h("th", { scope: "col" }, name, h("sub", {}, i < 2 ? before : "i")));
  const rows = labels.map((label, i) => {
    const isOwn = i === labels.length - 1;
    const cells = NAMES.map((name, j) => {
      const input = h("input", {
        type: "text",
        autocomplete: "off",
        autocapitalize: "off",
        spellcheck: "false",
        "aria-label": worded("{column}, row {row}", { column: name, row: label }),
      });
      return h("td", {}, isOwn ? input : [...typeset(texts[i][j]), j === 1 && texts[i][j] !== "0" ? "°" : ""]);
    });
    return h("tr", {}, h("th", { scope: "row" }, label), ...cells);
  });
  const caption = h(
    "caption",
    {},
    ...typeset(
      worded("Write row {row}: from frame {frame} to the tip.", {
        row: labels.at(-1) ?? "",
        frame: `{${labels.length - 1}}`,
      }),
    ),
  );
  const table = h(
    "table",
    { class: "worked-table" },
    caption,
    h("tr", {}, h("th", { scope: "col" }, worded("row")), ...heads),
    ...rows,
  );
  form.querySelector("table")?.remove();
  form.prepend(table);
}

writeTable();
const pictures = new Map(
  screens.filter(({ id }) => id !== "worked").map((each) => {
    const place = /** @type {HTMLElement} */ (each.querySelector(".picture"));
    return [each.id, new ArmPicture(each.id, place)];
  }),
);
const questions = new Map(
  [...main.querySelectorAll("form.question")].map((each) => {
    const id = each.closest(".screen")?.id ?? "";
    return [id, new Question(/** @type {HTMLFormElement} */ (each), service, () => solved(id))];
  }),
);

const links = new Map(
  screens.map(({ id }, i) => {
    const text = id === "worked" ? worded("Example") : String(i + 1);
    const name = screens[i].querySelector("h2")?.textContent?.trim() ?? id;
    return [
      id,
      h("a", { href: `#${id}`, "aria-label": name }, text, h("span", { class: "mark", "aria-hidden": "true" })),
    ];
  }),
);
const radios = Object.entries(CONVENTIONS).map(([value, text]) => {
  const box = h("input", {
    type: "radio",
    name: "convention",
    value,
    onchange: () => choose(/** @type {Api.Convention} */ (value)),
  });
  box.checked = value === progress.convention;
  return h("label", {}, box, " ", text);
});
tour.append(
  h(
    "fieldset",
    { class: "conventions" },
    h("legend", {}, worded("Your course's convention (not sure? Take standard)")),
    ...radios,
  ),
  h(
    "nav",
    { "aria-label": worded("Screens") },
    h("ol", { class: "screens" }, ...[...links.values()].map((each) => h("li", {}, each))),
  ),
);
tour.hidden = false;

for (const [i, screen] of screens.entries()) {
  const [before, after] = [screens[i - 1], screens[i + 1]];
  /** @type {(target: HTMLElement, text: string) => HTMLElement} */
  const link = (target, text) => h("a", { href: `#${target.id}` }, text);
  const ways = [before ? link(before, worded("← Back")) : h("span"), after && link(after, worded("Next →"))];
  screen.append(h("p", { class: "ways" }, ...ways));
}

/** @param {string} id */
function solved(id) {
  progress.solved = [...new Set([...progress.solved, key(id)])];
  keepProgress(progress);
  mark();
}

/** Mark the screens that are solved. */
function mark() {
  for (const [id, link] of links) {
    const isSolved = progress.solved.includes(key(id));
    link.classList.toggle("solved", isSolved);
    const name = screens.find((each) => each.id === id)?.querySelector("h2")?.textContent?.trim() ?? id;
    link.setAttribute("aria-label", isSolved ? worded("{screen} (solved)", { screen: name }) : name);
    const sign = link.querySelector(".mark");
    if (sign) sign.textContent = isSolved ? " ✓" : "";
  }
}

/** @param {Api.Convention} convention */
function choose(convention) {
  progress.convention = convention;
  main.dataset.convention = convention;
  keepProgress(progress);
  writeTable();
  for (const picture of pictures.values()) picture.show(convention);
  for (const [id, question] of questions) question.ask(convention, progress.solved.includes(key(id)));
  space.show(convention);
  mark();
}

/** Show the screen that contains the place in the address. @param {boolean} isMove */
function follow(isMove) {
  const place = document.getElementById(location.hash.slice(1));
  const current = screens.find((each) => each.contains(place)) ?? screens[0];
  for (const picture of pictures.values()) picture.stop();
  for (const screen of screens) screen.hidden = screen !== current;
  for (const [id, link] of links) {
    if (id === current.id) link.setAttribute("aria-current", "step");
    else link.removeAttribute("aria-current");
  }
  if (place && place !== current) return place.scrollIntoView({ block: "center" });
  if (!isMove) return;
  current.querySelector("h2")?.focus({ preventScroll: true });
  tour.scrollIntoView({ block: "start" });
}

addEventListener("hashchange", () => follow(true));
choose(progress.convention);
follow(false);
