"""Students' pages as HTML. They can be read without scripts."""

from collections.abc import Iterable, Iterator
from typing import Final

from markupsafe import Markup

from service.api.http.lookup import Catalogue
from service.catalogue import Exercise
from service.formats.shared.html_templates import html, own_html
from service.typeset.statement import statement_html
from service.web.assets import Assets

# The entries of the menu: text, and address relative to the root.
_MENU: Final = (("Exercises", ""), ("Free play", "play"), ("API", "docs"))
_TUTORS_MENU: Final = (*_MENU, ("For tutors", "tutor"))

_KIND_NAMES: Final = {
    "dh_table": "DH table",
    "dh_row": "DH row",
    "link_transforms": "link transforms",
    "euler_angles": "Euler angles",
    "screw_axes": "screw axes",
}


def catalogue_page(catalogue: Catalogue, assets: Assets, *, tutor: bool = False) -> bytes:
    """Return the page with the list of all exercises."""
    return page(
        "web/templates/catalogue.html",
        assets,
        "",
        ["page.js"],
        tutor=tutor,
        groups=list(_groups(catalogue.values())),
        kinds_of=_kinds_of,
    )


def exercise_page(exercise: Exercise, assets: Assets, *, tutor: bool = False) -> bytes:
    """Return the page of an exercise."""
    return page(
        "web/templates/exercise.html",
        assets,
        "../",
        ["page.js", "embed.js"],
        tutor=tutor,
        exercise=exercise,
        markdown=_markdown,
    )


def play_page(assets: Assets, *, tutor: bool = False) -> bytes:
    """Return the page of free play, which accepts the table of any robot."""
    return page("web/templates/play.html", assets, "", ["page.js", "play.js"], tutor=tutor)


def page(
    template: str,
    assets: Assets,
    root: str,
    scripts: Iterable[str],
    *,
    styles: Iterable[str] = (),
    tutor: bool = False,
    **values: object,
) -> bytes:
    """Return the page of a template that extends ``site.html``.

    ``root`` is the relative address of the catalogue. The menu has one more entry for a ``tutor``.
    ``values`` are the variables of the template.
    """
    static = f"{root}static/"
    modules = dict.fromkeys(name for script in scripts for name in assets.modules(script))
    return html(
        template,
        asset=lambda name: f"{static}{assets.name(name)}",
        menu=_TUTORS_MENU if tutor else _MENU,
        modules=[f"{static}{name}" for name in modules],
        root=root,
        scripts=list(scripts),
        styles=list(styles),
        **values,
    )


def _groups(exercises: Iterable[Exercise]) -> Iterator[tuple[str, list[Exercise]]]:
    """Yield each heading with its exercises: first those with a robot, then all others."""
    robots: list[Exercise] = []
    others: list[Exercise] = []
    for exercise in exercises:
        (others if exercise.reference is None else robots).append(exercise)
    for title, group in (("Robots", robots), ("Transforms, rotations and screws", others)):
        if group:
            yield title, group


def _kinds_of(exercise: Exercise) -> Iterable[str]:
    """Return the names of the kinds of its parts, each once."""
    return dict.fromkeys(_KIND_NAMES.get(part.kind, part.kind) for part in exercise.parts)


def _markdown(text: str, exercise: Exercise) -> Markup:
    """Return a text of the exercise's author as HTML."""
    return own_html(statement_html(text, exercise.symbols))
