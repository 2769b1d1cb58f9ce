"""The pages of students as HTML, which can be read without scripts."""

from collections.abc import Iterable
from typing import Final

from markupsafe import Markup

from service.api.http.lookup import Catalogue
from service.api.routes.reference import SCRIPT, START, STYLE
from service.catalogue import Exercise, by_level, in_language
from service.formats.shared.html_templates import html, own_html
from service.translations import ENGLISH, LANGUAGES, Language, say
from service.typeset.formulas import matrix
from service.typeset.names import typeset
from service.typeset.statement import statement_html
from service.variants.robots.practice_id import practice_id
from service.web.assets import Assets
from service.web.catalogue_words import kinds_of, words_of

# The entries of the menu: text, and address relative to the root.
_MENU: Final = (
    (say("Exercises"), ""),
    (say("Practice"), "practice"),
    (say("Free play"), "play"),
    (say("Help"), "help/expressions"),
)
_TUTORS_MENU: Final = (*_MENU, (say("For tutors"), "tutor"))
# The link transform of a row, in the standard and in the modified convention.
_TRANSFORMS: Final = (
    (
        "A_i = Rot_z(θ) Trans_z(d) Trans_x(a) Rot_x(α)",
        """cos(theta), -sin(theta)*cos(alpha), sin(theta)*sin(alpha), a*cos(theta)
        sin(theta), cos(theta)*cos(alpha), -cos(theta)*sin(alpha), a*sin(theta)
        0, sin(alpha), cos(alpha), d
        0, 0, 0, 1""",
    ),
    (
        "A_i = Rot_x(α) Trans_x(a) Rot_z(θ) Trans_z(d)",
        """cos(theta), -sin(theta), 0, a
        sin(theta)*cos(alpha), cos(theta)*cos(alpha), -sin(alpha), -d*sin(alpha)
        sin(theta)*sin(alpha), cos(theta)*sin(alpha), cos(alpha), d*cos(alpha)
        0, 0, 0, 1""",
    ),
)
_OF_A: Final = '<span class="maths">(<math><mi>a</mi></math>)</span>'


def catalogue_page(
    catalogue: Catalogue, assets: Assets, language: Language, *, tutor: bool = False
) -> bytes:
    """Return the page with the list of all exercises."""
    shown = [in_language(each, language) for each in catalogue.values()]
    return page(
        "web/templates/catalogue.html",
        assets,
        "",
        ["page.js", "catalogue.js"],
        styles=["catalogue.css"],
        language=language,
        tutor=tutor,
        groups=by_level(shown),
        kinds_of=kinds_of,
        # An English word finds an exercise in every language.
        words_of=lambda it: words_of(it, language, catalogue[it.id]),
    )


def exercise_page(
    exercise: Exercise,
    following: Exercise | None,
    assets: Assets,
    language: Language,
    *,
    tutor: bool = False,
) -> bytes:
    """Return the page of an exercise, with a link to the next exercise ``following``."""
    return page(
        "web/templates/exercise.html",
        assets,
        "../",
        ["page.js", "embed.js"],
        styles=["print.css"],
        language=language,
        tutor=tutor,
        exercise=in_language(exercise, language),
        next=following and in_language(following, language),
        is_generated=practice_id(exercise.id) is not None,
        markdown=_markdown,
    )


def play_page(assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the page of free play, which accepts the table of any robot."""
    return page(
        "web/templates/play.html",
        assets,
        "",
        ["page.js", "play.js"],
        language=language,
        tutor=tutor,
    )


def practice_page(assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the page for practice with generated robots."""
    # A script loads one after the other.
    return page(
        "web/templates/practice.html",
        assets,
        "",
        ["page.js", "embed.js", "practice.js"],
        styles=["print.css"],
        language=language,
        tutor=tutor,
    )


def ten_minutes_page(assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the page "DH in ten minutes"."""
    # It can be read without scripts.
    return page(
        "web/templates/learn_dh.html",
        assets,
        "",
        ["page.js", "ten_minutes.js"],
        styles=["ten_minutes.css"],
        language=language,
        tutor=tutor,
        transforms=[
            # As a word of a sentence, "a" is no name.
            own_html(f"{typeset(moves, {'d'}).replace('(a)', _OF_A)} = {matrix(entries)}")
            for moves, entries in _TRANSFORMS
        ],
    )


def learner_page(assets: Assets, language: Language) -> bytes:
    """Return the page of a learner with a personal link."""
    # Its script loads the assignments.
    return page(
        "web/templates/learn.html",
        assets,
        "",
        ["page.js", "embed.js", "learner.js"],
        styles=["learner.css"],
        language=language,
        key="",
        place="",
    )


def reference_page(assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the page /docs, the reference of the HTTP interface."""
    return page(
        "web/templates/docs.html",
        assets,
        "",
        ["page.js"],
        styles=["docs.css"],
        language=language,
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
    language: Language | None = None,
    tutor: bool = False,
    is_framed: bool = False,
    **values: object,
) -> bytes:
    """Return the page made from a template that extends ``site.html``.

    ``root`` is the relative address of the catalogue, and ``values`` are the template's variables.
    With ``is_framed``, the page has no menu.
    """
    # Other pages do not open in a frame. The menu has one more entry for a ``tutor``. A page
    # without a ``language`` is in English, and offers no other language.
    static = f"{root}static/"
    offers = language is not None and not is_framed and len(LANGUAGES) > 1
    modules = dict.fromkeys(name for script in scripts for name in assets.modules(script))
    words = assets.words(language) if language else None
    if words and assets.name("words.js") in modules:
        modules[words] = None
    return html(
        template,
        language=language or ENGLISH,
        languages=list(LANGUAGES.values()) if offers else [],
        asset=lambda name: f"{static}{assets.name(name)}",
        menu=_TUTORS_MENU if tutor else _MENU,
        modules=[f"{static}{name}" for name in modules],
        root=root,
        scripts=list(scripts),
        styles=list(styles),
        is_framed=is_framed,
        **values,
    )


def _markdown(text: str, exercise: Exercise) -> Markup:
    """Return the HTML of a text that the exercise's author has written in Markdown."""
    return own_html(statement_html(text, exercise.symbols))
