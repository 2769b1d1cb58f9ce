"""The pages as HTML. All of a page that can be read without a script is in it."""

from collections.abc import Iterable, Iterator
from typing import Final
from xml.etree.ElementTree import Element, fromstring, tostring

from service.api.http.lookup import Catalogue
from service.api.statement import statement_html
from service.catalogue import Exercise, PartSpec
from service.formats.shared.markup import Child, element
from service.formats.shared.plain_text import number
from service.web.assets import Assets

# The entries of the menu: text and address, from the root.
_MENU: Final = (("Exercises", ""), ("Free play", "play"), ("API", "docs"))

_NOTE: Final = "Nothing that you write here is recorded. Answers stay in this browser."
TUTORS_NOTE: Final = "What is recorded of students is for tutors alone."
_TUTOR: Final = (("For tutors", "tutor"),)

_KIND_NAMES: Final = {
    "dh_table": "DH table",
    "dh_row": "DH row",
    "link_transforms": "link transforms",
    "euler_angles": "Euler angles",
    "screw_axes": "screw axes",
}


def catalogue_page(catalogue: Catalogue, assets: Assets, *, tutor: bool = False) -> bytes:
    """All exercises, to choose one from."""
    main = element(
        "main",
        element(
            "div",
            element("h1", "Forward kinematics, checked as you type"),
            element(
                "p",
                "Fill in a Denavit-Hartenberg table or a matrix and see at once how each entry is "
                "understood. Every valid choice of frames counts as right; a slip is named in its "
                "row and does not cost the rows after it.",
                class_="lead",
            ),
            class_="hero",
        ),
        _search(),
        element("p", class_="none-found", hidden="", id="none-found")
        if catalogue
        else element("p", "This service has no exercises yet.", class_="none-found"),
        *_groups(catalogue.values()),
        id="main",
    )
    return page("DH Grader", main, assets, "", ["page.js"], tutor=tutor)


def exercise_page(exercise: Exercise, assets: Assets, *, tutor: bool = False) -> bytes:
    """One exercise: its element, which holds what can be read without a script."""
    inside = element(
        "dh-exercise",
        element("h1", exercise.title),
        element("p", exercise.source, class_="quiet"),
        *_statement(exercise),
        *(_part(part) for part in exercise.parts),
        element(
            "noscript",
            element(
                "p",
                "Scripts are off in this browser. You can read the exercise; to fill in and check "
                "answers here, the page needs them.",
                class_="notice",
            ),
        ),
        exercise=exercise.id,
        linked="",
    )
    main = element("main", inside, id="main", class_="exercise")
    title = f"{exercise.title} · DH Grader"
    return page(title, main, assets, "../", ["page.js", "embed.js"], tutor=tutor)


def play_page(assets: Assets, *, tutor: bool = False) -> bytes:
    """Any table of any robot."""
    inside = element(
        "dh-play",
        element("h1", "Free play"),
        element("p", "Write any DH table, see its robot, and move it.", class_="lead"),
        element(
            "noscript",
            element("p", "Scripts are off in this browser; free play needs them.", class_="notice"),
        ),
    )
    main = element("main", inside, id="main", class_="exercise")
    title = "Free play · DH Grader"
    return page(title, main, assets, "", ["page.js", "play.js"], tutor=tutor)


def _search() -> Element:
    """The field that narrows the list; without a script it stays hidden."""
    field = element("input", type="search", id="search", autocomplete="off", spellcheck="false")
    field.set("placeholder", "SCARA, RRP, screw axes …")
    label = element("label", "Find an exercise", for_="search")
    count = element("p", class_="quiet", id="count", role="status")
    return element("form", label, field, count, class_="search", role="search", hidden="")


def _groups(exercises: Iterable[Exercise]) -> Iterator[Element]:
    """Robots, which have pictures, and all the rest."""
    robots: list[Element] = []
    others: list[Element] = []
    for exercise in exercises:
        (others if exercise.reference is None else robots).append(_item(exercise))
    for title, items in (("Robots", robots), ("Transforms, rotations and screws", others)):
        if items:
            cards = element("ul", *items, class_="exercises")
            yield element("section", element("h2", title), cards, class_="group")


def _item(exercise: Exercise) -> Element:
    kinds = dict.fromkeys(_KIND_NAMES.get(part.kind, part.kind) for part in exercise.parts)
    tags = [element("li", kind) for kind in kinds]
    if exercise.structure:
        joints = element("li", exercise.structure, class_="joints", title="joints in order")
        tags.insert(0, joints)
    total = sum(part.points for part in exercise.parts)
    heading = element("h3", element("a", exercise.title, href=f"exercises/{exercise.id}"))
    # The title says which robot it is; a picture's text would say it twice.
    drawn = [element("div", _figure(exercise, "", ""), class_="thumbnail")]
    return element(
        "li",
        *(drawn if exercise.reference is not None else []),
        heading,
        element("p", exercise.source, class_="quiet"),
        element("ul", *tags, class_="tags"),
        element("p", f"{number(total)} points", class_="worth"),
        class_="card",
    )


def _statement(exercise: Exercise) -> Iterable[Element]:
    if exercise.reference is not None:
        yield element("figure", _figure(exercise, "../", f"The robot: {exercise.title}"))
    yield _written(exercise.statement)


def _written(markdown: str) -> Element:
    """A text of the exercise's author."""
    written = fromstring(f"<div>{statement_html(markdown)}</div>")
    for each in written.iter():
        # HTML knows MathML by its names alone.
        each.tag = each.tag.rpartition("}")[2]
    return written


def _figure(exercise: Exercise, root: str, alt: str) -> Element:
    address = f"{root}v1/exercises/{exercise.id}/figure.svg"
    return element("img", src=address, alt=alt, loading="lazy")


def _part(part: PartSpec) -> Element:
    return element("section", element("h2", part.title), _written(part.prompt))


def page(
    title: str,
    main: Element,
    assets: Assets,
    root: str,
    scripts: Iterable[str],
    *,
    styles: Iterable[str] = (),
    tutor: bool = False,
    note: str = _NOTE,
) -> bytes:
    """A whole page; ``root`` leads from its address to that of the catalogue.

    The menu leads a ``tutor`` to more. ``note`` stands at the end of the page.
    """
    static = f"{root}static/"
    modules = dict.fromkeys(name for script in scripts for name in assets.modules(script))
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", name="color-scheme", content="light dark"),
        element("title", title),
        element("link", rel="icon", href=static + assets.name("icon.svg"), type="image/svg+xml"),
        element("link", rel="stylesheet", href=static + assets.name("tokens.css")),
        *(
            element("link", rel="stylesheet", href=static + assets.name(style))
            for style in ("page.css", *styles)
        ),
        *(element("link", rel="modulepreload", href=static + name) for name in modules),
        *(element("script", type="module", src=static + assets.name(script)) for script in scripts),
    )
    body = element("body", *_header(root, assets, tutor=tutor), main, _footer(root, note))
    document = element("html", head, body, lang="en")
    written: bytes = tostring(document, encoding="utf-8", method="html")
    return b"<!doctype html>\n" + written


def _header(root: str, assets: Assets, *, tutor: bool) -> Iterable[Element]:
    yield element("a", "Skip to the content", href="#main", class_="skip")
    icon = element("img", src=f"{root}static/{assets.name('icon.svg')}", alt="", class_="logo")
    links: list[Child] = [
        element("a", name, href=(root + address) or ".")
        for name, address in (*_MENU, *(_TUTOR if tutor else ()))
    ]
    brand = element("a", icon, "DH Grader", href=root or ".", class_="brand")
    theme = element("div", id="theme", class_="theme")
    yield element("header", brand, element("nav", *links, aria_label="Main"), theme, class_="top")


def _footer(root: str, note: str) -> Element:
    return element(
        "footer",
        element(
            "p",
            f"{note} ",
            element("a", "Interface for programs", href=f"{root}docs"),
        ),
        class_="bottom",
    )
