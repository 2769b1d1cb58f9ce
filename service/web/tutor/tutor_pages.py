"""A tutor's pages as HTML."""

from collections.abc import Iterable, Mapping
from typing import Final
from xml.etree.ElementTree import Element, fromstring

from service.api.http.lookup import Catalogue
from service.api.statement import formula_html
from service.catalogue import Exercise, Robot
from service.formats.shared.markup import Child, element
from service.formats.shared.plain_text import visible
from service.solutions import solve
from service.solutions.model_solution import Shown
from service.web.assets import Assets
from service.web.pages import TUTORS_NOTE, page

_SCRIPTS: Final = ("page.js",)


def tutor_page(catalogue: Catalogue, assets: Assets, *, of_all: bool = True) -> bytes:
    """The way to all that there is for tutors.

    Without what is ``of_all`` exercises: the editor and the report on a class.
    """
    columns = [*_COLUMNS, _FILE] if of_all else _COLUMNS
    head = element("tr", *(element("th", name, scope="col") for name in columns))
    rows = (_row(each, can_edit=of_all) for each in catalogue.values())
    table = element("table", element("thead", head), element("tbody", *rows), class_="plain")
    main = element(
        "main",
        element("h1", "For tutors"),
        element("ul", *_ways(of_all=of_all), class_="exercises ways"),
        element("h2", "Exercises", id="exercises"),
        element(
            "div", table, class_="wide", tabindex="0", role="region", aria_labelledby="exercises"
        ),
        id="main",
    )
    return _page("For tutors · DH Grader", main, assets, "", _SCRIPTS)


_COLUMNS: Final = ("Exercise", "Id", "Solution", "Attempts")
_FILE: Final = "File"


def _row(exercise: Exercise, *, can_edit: bool) -> Element:
    name, of = exercise.id, _of(exercise)
    links = [
        element("a", "Solution", *of, href=f"tutor/solutions/{name}"),
        element("a", "Statistics", *of, href=f"tutor/statistics/{name}"),
    ]
    if can_edit:
        links.append(element("a", "Edit", *of, href=f"tutor/editor?exercise={name}"))
    return element(
        "tr",
        element("th", element("a", exercise.title, href=f"exercises/{name}"), scope="row"),
        element("td", element("code", name)),
        *(element("td", link) for link in links),
    )


def _ways(*, of_all: bool) -> Iterable[Element]:
    if of_all:
        yield _way(
            "Write an exercise", "tutor/editor", "A file to start from, checked as you type."
        )
        yield _way(
            "Report on a class",
            "tutor/class",
            "Choose the folder that your platform gave you: scores, slips, a page for each "
            "student.",
        )
    yield _way(
        "Recorded attempts",
        "tutor/attempts",
        "What students handed in, where the service has a database: read, export, give "
        "other points, regrade" + (", forget." if of_all else "."),
    )


def _page(title: str, main: Element, assets: Assets, root: str, scripts: Iterable[str]) -> bytes:
    styles = ["tutor.css"]
    return page(title, main, assets, root, scripts, styles=styles, tutor=True, note=TUTORS_NOTE)


def _of(exercise: Exercise) -> list[Child]:
    """Which exercise a link is about, for who hears it alone."""
    return [element("span", f" of {exercise.title}", class_="aloud")]


def _way(title: str, address: str, text: str) -> Element:
    heading = element("h2", element("a", title, href=address))
    return element("li", heading, element("p", text), class_="card")


def solution_page(exercise: Exercise, assets: Assets, *, of_all: bool = True) -> bytes:
    """The right answer to each part, with the steps that lead to it.

    The way to the editor is for who may see what is ``of_all`` exercises.
    """
    root = "../../"
    solution = solve(exercise)
    links = element("p", class_="ways-on")
    links.append(element("a", "The exercise", href=f"{root}exercises/{exercise.id}"))
    if of_all:
        links.append(element("a", "Edit its file", href=f"../editor?exercise={exercise.id}"))
    main = element(
        "main",
        element("p", "Model solution", class_="kicker"),
        element("h1", exercise.title),
        element("p", exercise.source, class_="quiet"),
        links,
        id="main",
        class_="solution",
    )
    if isinstance(exercise.reference, Robot):
        address = f"{exercise.id}/frames.svg"
        alt = f"The robot with the frames of the reference's table: {exercise.title}"
        main.append(element("figure", element("img", src=address, alt=alt)))
    main.extend(_section(f"{each.title}", each) for each in solution.parts)
    if solution.links and not any(part.holds_links for part in exercise.parts):
        heading = element("h2", "Link transforms")
        shown = (_shown(each, f"A_{{{each.label}}}") for each in solution.links)
        main.append(element("section", heading, *shown, class_="card"))
    answered = [part.text for part in solution.parts]
    if solution.pose is not None and solution.pose.text not in answered:
        main.append(_section("Pose of the tool in the base frame", solution.pose))
    if solution.notation:
        main.append(_notation(solution.notation))
    title = f"Solution: {exercise.title} · DH Grader"
    return _page(title, main, assets, root, _SCRIPTS)


def _section(title: str, shown: Shown) -> Element:
    return element("section", element("h2", title), _shown(shown), class_="card")


def _shown(shown: Shown, name: str = "") -> Element:
    """An answer as it is printed, and below it the texts to copy."""
    latex = f"{name} = {shown.latex}" if name else shown.latex
    drawn = _table(shown.latex) if shown.latex.startswith(_TABULAR) else _formula(latex)
    sources = (("Text", shown.text), ("LaTeX", shown.latex))
    return element(
        "div",
        element("div", drawn, class_="wide", tabindex="0", role="group", aria_label="Answer"),
        *(
            element("details", element("summary", label), _code(text), class_="source")
            for label, text in sources
        ),
    )


def _code(text: str) -> Element:
    code = element("code")
    # Its lines stay lines; `element` would make one of them.
    code.text = "\n".join(map(visible, text.split("\n")))
    return element("pre", code, tabindex="0")


# A table of LaTeX as the model solutions write it: cells between dollars, a line each row.
_TABULAR: Final = r"\begin{tabular}"


def _table(latex: str) -> Element:
    lines = [line.removesuffix(r" \\") for line in latex.split("\n") if line.endswith(r" \\")]
    head, *rows = ([cell.strip("$") for cell in line.split(" & ")] for line in lines)
    top = element("tr", *(_head(cell, "col") for cell in head))
    body = (
        element(
            "tr",
            _head(row[0], "row"),
            *(element("td", _formula(cell)) for cell in row[1:]),
        )
        for row in rows
    )
    return element("table", element("thead", top), element("tbody", *body), class_="plain")


def _head(latex: str, scope: str) -> Element:
    """A head with a name in words: not everybody who hears it hears MathML."""
    spoken = latex.translate(str.maketrans("_", " ", "\\{}"))
    aloud = element("span", spoken, class_="aloud")
    seen = element("span", _formula(latex), aria_hidden="true")
    return element("th", seen, aloud, scope=scope)


def _formula(latex: str) -> Element:
    formula = fromstring(formula_html(latex, display=latex.startswith(("\\begin", "A_"))))
    for parent in list(formula.iter()):
        _draw_brackets(parent)
    return formula


def _draw_brackets(parent: Element) -> None:
    """Leave the brackets of matrices to the style sheet: few fonts have brackets that grow."""
    for table in parent.findall("mtable"):
        at = list(parent).index(table)
        around = [parent[i] for i in (at - 1, at + 1) if 0 <= i < len(parent)]
        if [each.text for each in around] == ["[", "]"]:
            table.set("class", "bracketed")
            for bracket in around:
                parent.remove(bracket)


def _notation(notation: Mapping[str, str]) -> Element:
    pairs: list[Child] = []
    for name, meaning in notation.items():
        pairs += [element("dt", element("code", name)), element("dd", element("code", meaning))]
    return element("section", element("h2", "Shorthand"), element("dl", *pairs), class_="card")


def editor_page(
    exercise_id: str, text: str, mark: str, assets: Assets, *, can_write: bool
) -> bytes:
    """The editor with a text in it."""
    area = element("textarea", id="text", spellcheck="false", autocomplete="off", wrap="off")
    area.set("aria-label", "Exercise file, TOML")
    area.set("autocapitalize", "off")
    # The first line break of a text area is not part of its text.
    area.text = f"\n{text}"
    name = element(
        "input",
        id="id",
        value=exercise_id,
        maxlength="60",
        autocomplete="off",
        spellcheck="false",
        size="24",
    )
    save = [element("button", "Save", type="button", id="save")] if can_write else []
    main = element(
        "main",
        element("h1", "Exercise editor"),
        element(
            "form",
            element("label", "Id, the name of the file", for_="id"),
            name,
            element("button", "Download", type="button", id="download"),
            *save,
            element("p", id="saved", class_="quiet", role="status"),
            class_="editor-bar",
        ),
        element(
            "div",
            element("div", element("div", id="numbers", aria_hidden="true"), area, class_="text"),
            element(
                "div",
                element(
                    "section",
                    element("h2", "Findings"),
                    element("p", "Checking …"),
                    id="findings",
                    aria_live="polite",
                ),
                element("section", element("h2", "What students see"), id="preview"),
                class_="beside",
            ),
            class_="editor",
        ),
        element("noscript", element("p", "The editor needs scripts.", class_="notice")),
        id="main",
        data_mark=mark,
    )
    return _page("Exercise editor · DH Grader", main, assets, "../", ["page.js", "editor.js"])


def class_page(catalogue: Catalogue, assets: Assets) -> bytes:
    """The form to choose exercise and files on, and the place of the report."""
    options = (element("option", each.title, value=each.id) for each in catalogue.values())
    folder = element("input", type="file", id="folder", webkitdirectory="", multiple="")
    main = element(
        "main",
        element("h1", "Report on a class", id="title"),
        element(
            "p",
            "Choose the folder of a class as your platform gave it to you, unpacked: each file in "
            "it is one student's, and so is each folder. The files are graded and not kept; large "
            "classes go to ",
            element("code", "dh-grader grade FOLDER --format html"),
            ".",
            class_="lead",
        ),
        element(
            "form",
            element("label", "Exercise", for_="exercise"),
            element("select", *options, id="exercise"),
            element("label", "Part", for_="part"),
            element("select", element("option", "All parts", value=""), id="part"),
            element("label", "Folder", for_="folder"),
            folder,
            element("label", "or files", for_="files"),
            element("input", type="file", id="files", multiple=""),
            class_="class-form",
        ),
        element("p", id="state", role="status", class_="state-line"),
        element(
            "div",
            element("button", "Back to the class", type="button", id="back", hidden=""),
            element("button", "Download all pages", type="button", id="download"),
            id="report-bar",
            class_="editor-bar",
            hidden="",
        ),
        element("iframe", id="report", title="Report on the class", hidden=""),
        element("noscript", element("p", "This page needs scripts.", class_="notice")),
        id="main",
        aria_labelledby="title",
    )
    return _page("Report on a class · DH Grader", main, assets, "../", ["page.js", "class.js"])
