"""Students' pages as HTML. They can be read without scripts."""

from collections.abc import Iterable
from typing import Final

from markupsafe import Markup

from service.api.http.lookup import Catalogue
from service.api.routes.reference import SCRIPT, START, STYLE
from service.catalogue import Exercise, by_level
from service.formats.shared.html_templates import html, own_html
from service.typeset.statement import statement_html
from service.variants.robots.practice_id import practice_id
from service.web.assets import Assets
from service.web.catalogue_words import kinds_of, words_of

# The entries of the menu: text, and address relative to the root.
_MENU: Final = (("Exercises", ""), ("Practice", "practice"), ("Free play", "play"), ("API", "docs"))
_TUTORS_MENU: Final = (*_MENU, ("For tutors", "tutor"))


def catalogue_page(catalogue: Catalogue, assets: Assets, *, tutor: bool = False) -> bytes:
    """Return the page with the list of all exercises."""
    return page(
        "web/templates/catalogue.html",
        assets,
        "",
        ["page.js", "catalogue.js"],
        styles=["catalogue.css"],
        tutor=tutor,
        groups=by_level(catalogue.values()),
        kinds_of=kinds_of,
        words_of=words_of,
    )


def exercise_page(
    exercise: Exercise, following: Exercise | None, assets: Assets, *, tutor: bool = False
) -> bytes:
    """Return the page of an exercise, with a link to the ``following`` one."""
    return page(
        "web/templates/exercise.html",
        assets,
        "../",
        ["page.js", "embed.js"],
        styles=["print.css"],
        tutor=tutor,
        exercise=exercise,
        next=following,
        is_generated=practice_id(exercise.id) is not None,
        markdown=_markdown,
    )


def play_page(assets: Assets, *, tutor: bool = False) -> bytes:
    """Return the page of free play, which accepts the table of any robot."""
    return page("web/templates/play.html", assets, "", ["page.js", "play.js"], tutor=tutor)


def practice_page(assets: Assets, *, tutor: bool = False) -> bytes:
    """Return the page of generated robots; the element deals them."""
    return page(
        "web/templates/practice.html",
        assets,
        "",
        ["page.js", "embed.js", "practice.js"],
        styles=["print.css"],
        tutor=tutor,
    )


def ten_minutes_page(assets: Assets, *, tutor: bool = False) -> bytes:
    """Return the page "DH in ten minutes"; it can be read without scripts."""
    return page(
        "web/templates/learn_dh.html",
        assets,
        "",
        ["page.js", "ten_minutes.js"],
        styles=["ten_minutes.css"],
        tutor=tutor,
    )


def learner_page(assets: Assets) -> bytes:
    """Return the page of a learner with a personal link; its script loads the assignments."""
    return page(
        "web/templates/learn.html",
        assets,
        "",
        ["page.js", "embed.js", "learner.js"],
        styles=["learner.css"],
        key="",
        place="",
    )


def reference_page(assets: Assets, *, tutor: bool = False) -> bytes:
    """Return the page /docs, on which people read and try the operations."""
    return page(
        "web/templates/docs.html",
        assets,
        "",
        ["page.js"],
        styles=["docs.css"],
        tutor=tutor,
        swagger=[SCRIPT, START],
        swagger_style=STYLE,
    )


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
    With ``is_framed``, a page has no menu: no other page opens in a frame.
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
        **{"is_framed": False, **values},
    )


def _markdown(text: str, exercise: Exercise) -> Markup:
    """Return a text of the exercise's author as HTML."""
    return own_html(statement_html(text, exercise.symbols))
