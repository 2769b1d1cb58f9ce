"""The pages for tutors as HTML."""

from typing import Any, Final

from markupsafe import Markup

from service.api.http.lookup import Catalogue
from service.catalogue import Exercise, Robot, in_language
from service.formats.shared.html_templates import own_html
from service.solutions import solve
from service.translations import Language, told
from service.typeset.statement import formula_html
from service.web.assets import Assets
from service.web.pages import page

# The start of tables in LaTeX. Model solutions have cells between dollars, and a line for each row.
_TABULAR: Final = r"\begin{tabular}"


def tutor_page(
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
    *,
    of_all: bool = True,
    has_courses: bool = False,
    has_platforms: bool = False,
    signed_in: bool = False,
) -> bytes:
    """Return the home page of tutors, with links to all pages for tutors."""
    # Without ``of_all``, it has no links to the editor and the report on a class.
    return _page(
        "home",
        assets,
        "",
        language=language,
        exercises=[in_language(each, language) for each in catalogue.values()],
        of_all=of_all,
        has_courses=has_courses,
        has_platforms=has_platforms,
        signed_in=signed_in,
    )


def solution_page(
    exercise: Exercise, assets: Assets, language: Language, *, of_all: bool = True
) -> bytes:
    """Return the page with the correct answers to an exercise, and the steps to find them."""
    # Without ``of_all``, it has no link to the editor.
    exercise = in_language(exercise, language)
    solution = solve(exercise)
    pose, answered = solution.pose, [part.text for part in solution.parts]
    return _page(
        "solution",
        assets,
        "../../",
        language=language,
        exercise=exercise,
        of_all=of_all,
        has_frames=isinstance(exercise.reference, Robot),
        solution=solution,
        links=() if any(part.holds_links for part in exercise.parts) else solution.links,
        pose=None if pose is None or pose.text in answered else pose,
        formula=_formula,
        is_table=lambda latex: latex.startswith(_TABULAR),
        spoken=_spoken,
        table_of=_table_of,
    )


def misconceptions_page(
    exercise: Exercise, catalogue: Catalogue, assets: Assets, language: Language
) -> bytes:
    """Return the page with all mistakes that the grader can name in an exercise."""
    # Imported here, because it loads an algebra system.
    from service.authoring.misconceptions import misconceptions_of

    return _page(
        "misconceptions",
        assets,
        "../../",
        language=language,
        exercise=in_language(exercise, language),
        misconceptions=misconceptions_of(exercise, catalogue),
        told=lambda sentence: told(sentence, language.translation),
    )


def editor_page(
    exercise_id: str,
    text: str,
    mark: str,
    assets: Assets,
    language: Language,
    *,
    can_write: bool,
    copied: str = "",
) -> bytes:
    """Return the page of the editor with this text.

    ``copied`` is the id of the exercise from which the text was copied, or "".
    """
    return _page(
        "editor",
        assets,
        "../",
        "editor.js",
        language=language,
        exercise_id=exercise_id,
        text=text,
        mark=mark,
        can_write=can_write,
        copied=copied,
    )


def class_page(catalogue: Catalogue, assets: Assets, language: Language) -> bytes:
    """Return the page on which a tutor uploads the files of a class."""
    exercises = [in_language(each, language) for each in catalogue.values()]
    return _page("class", assets, "../", "class.js", language=language, exercises=exercises)


def _page(name: str, assets: Assets, root: str, *scripts: str, **values: Any) -> bytes:
    return page(
        f"web/tutor/templates/{name}.html",
        assets,
        root,
        ["page.js", *scripts],
        styles=["tutor.css"],
        tutor=True,
        **values,
    )


def _table_of(latex: str) -> tuple[list[str], list[tuple[str, list[str]]]]:
    """Return the column names of a LaTeX table, and its rows as pairs of label and cells."""
    lines = [line.removesuffix(r" \\") for line in latex.split("\n") if line.endswith(r" \\")]
    names, *rows = ([cell.strip("$") for cell in line.split(" & ")] for line in lines)
    return names, [(label, cells) for label, *cells in rows]


def _spoken(latex: str) -> str:
    """Return a name in LaTeX as plain words, to be read aloud."""
    return latex.translate(str.maketrans("_", " ", "\\{}"))


def _formula(latex: str) -> Markup:
    """Return a formula of a model solution as MathML."""
    return own_html(formula_html(latex, display=latex.startswith(("\\begin", "A_"))))
