"""The pages of recorded attempts as HTML: forms and empty places, which their scripts fill."""

from collections.abc import Iterable, Iterator
from typing import Final
from xml.etree.ElementTree import Element

from service.api.http.lookup import Catalogue
from service.catalogue import Exercise
from service.formats.shared.markup import Child, element
from service.web.assets import Assets
from service.web.pages import TUTORS_NOTE, page

_FORMATS: Final = {"csv": "CSV", "jsonl": "JSON lines", "canvas": "Canvas", "moodle": "Moodle"}
_COUNTED: Final = (
    ("", "All"), ("true", "Those that could be read"), ("false", "Those that could not be read")
)  # fmt: skip


def attempts_page(catalogue: Catalogue, assets: Assets, *, of_all: bool = True) -> bytes:
    """The list of attempts with its filters, the export, and what forgets a learner.

    ``of_all`` where it may be of all exercises at once, as what forgets always is.
    """
    all_of_them = [("", "All exercises")] if of_all else []
    exercises = [*all_of_them, *((each.id, each.title) for each in catalogue.values())]
    main = element(
        "main",
        element("h1", "Recorded attempts"),
        element(
            "form",
            *_field("Exercise", _choice("exercise", exercises)),
            *_field("Learner", _input("learner", "text", maxlength="200")),
            *_dates(),
            *_field("Which", _choice("counted", _COUNTED)),
            element("button", "Show", type="submit"),
            id="filters",
            class_="filters",
            aria_label="Filters",
        ),
        element("p", id="state", role="status", class_="state-line"),
        element("div", id="list"),
        element(
            "section",
            element("h2", "Export"),
            element("p", "The attempts of the list, all pages of it.", class_="quiet"),
            _exports(),
            element(
                "p",
                "A gradebook (Canvas, Moodle) has one column for one exercise: choose it above.",
                class_="quiet for-books",
            ),
            id="export",
            class_="card",
        ),
        *([_forgetting()] if of_all else []),
        _noscript(),
        id="main",
        class_="records",
    )
    return _page("Recorded attempts", main, assets, "../", "attempts.js")


def _forgetting() -> Element:
    return element(
        "section",
        element("h2", "Forget a learner"),
        element(
            "p",
            "Deletes answers, reports and given points of one learner in all exercises, for ever.",
            class_="quiet",
        ),
        element(
            "form",
            *_field("Learner", _input("forgotten", "text", maxlength="200", required="")),
            element("button", "Look up", type="submit"),
            id="forget",
            class_="line-form",
        ),
        element("p", id="forget-state", role="status", class_="state-line"),
        class_="card",
    )


def attempt_page(attempt_id: str, assets: Assets) -> bytes:
    """One attempt: what was handed in, its report, and the points that a tutor gives."""
    back = element("a", "List of attempts", href="../attempts", id="back-to-list")
    main = element(
        "main",
        element("p", "Recorded attempt", class_="kicker"),
        element("h1", "Attempt", id="title"),
        element("p", back, class_="ways-on"),
        element("p", "Loading …", id="state", role="status", class_="state-line"),
        element("div", id="attempt", class_="attempt"),
        _noscript(),
        id="main",
        class_="records",
        data_attempt=attempt_id,
    )
    return _page("Recorded attempt", main, assets, "../../", "attempt.js")


def statistics_page(exercise: Exercise, assets: Assets) -> bytes:
    """The attempts at an exercise in counts, their export, and their regrade."""
    root = "../../"
    main = element(
        "main",
        element("p", "Attempts in counts", class_="kicker"),
        element("h1", exercise.title),
        element(
            "p",
            element("a", "List of attempts", href=f"../attempts?exercise={exercise.id}"),
            element("a", "Model solution", href=f"../solutions/{exercise.id}"),
            element("a", "The exercise", href=f"{root}exercises/{exercise.id}"),
            element("a", "Export", href="#export"),
            element("a", "Regrade", href="#regrade"),
            class_="ways-on",
        ),
        element(
            "form",
            *_dates(),
            element("button", "Show", type="submit"),
            id="filters",
            class_="filters",
            aria_label="Span of time",
        ),
        element("p", id="state", role="status", class_="state-line"),
        element("div", id="statistics", class_="statistics"),
        element("section", element("h2", "Export"), _exports(), id="export", class_="card"),
        element("section", element("h2", "Regrade"), id="regrade", class_="card"),
        _noscript(),
        id="main",
        class_="records",
        data_exercise=exercise.id,
    )
    return _page(f"Statistics: {exercise.title}", main, assets, root, "statistics.js")


def nothing_recorded_page(assets: Assets, root: str) -> bytes:
    """How the service is started so that it records."""
    command = element("code", "DH_GRADER_DATABASE=attempts.db dh-grader serve")
    main = element(
        "main",
        element("h1", "Recorded attempts"),
        element(
            "section",
            element("h2", "Nothing is recorded here"),
            element(
                "p",
                "The service has no database. With one, it keeps what courses have it record:",
            ),
            element("pre", command, tabindex="0"),
            element(
                "p",
                "The value is a file, which is made where there is none, or the URL of a "
                "PostgreSQL database.",
                class_="quiet",
            ),
            class_="empty",
        ),
        id="main",
        class_="records",
    )
    return _page("Recorded attempts", main, assets, root)


def _page(title: str, main: Element, assets: Assets, root: str, *scripts: str) -> bytes:
    return page(
        f"{title} · DH Grader",
        main,
        assets,
        root,
        ["page.js", *scripts],
        styles=["tutor.css", "records.css"],
        tutor=True,
        note=TUTORS_NOTE,
    )


def _field(label: str, control: Element) -> Iterator[Child]:
    yield element(
        "div", element("label", label, for_=control.get("id") or ""), control, class_="field"
    )


def _dates() -> Iterator[Child]:
    yield from _field("From", _input("since", "date"))
    yield from _field("To, this day included", _input("until", "date"))


def _input(name: str, kind: str, **more: str) -> Element:
    return element("input", id=name, type=kind, autocomplete="off", spellcheck="false", **more)


def _choice(name: str, options: Iterable[tuple[str, str]]) -> Element:
    return element(
        "select", *(element("option", text, value=value) for value, text in options), id=name
    )


def _exports() -> Element:
    links = (
        element("li", element("a", name, href="#export", data_format=form, download=""))
        for form, name in _FORMATS.items()
    )
    return element("ul", *links, class_="exports")


def _noscript() -> Element:
    return element("noscript", element("p", "This page needs scripts.", class_="notice"))
