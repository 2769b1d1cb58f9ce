"""The pages of recorded attempts as HTML, which scripts fill."""

from typing import Any, NamedTuple

from service.api.http.lookup import Catalogue
from service.catalogue import Exercise, in_language
from service.translations import Language, say
from service.web.assets import Assets
from service.web.pages import page


class CoursePlace(NamedTuple):
    """The course and the assignment whose attempts a page shows; "" means all."""

    course: str = ""
    assignment: str = ""


def attempts_page(
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
    place: CoursePlace,
    *,
    of_all: bool = True,
    forgets: bool = True,
) -> bytes:
    """Return the page with the list of attempts, its filters, the export, and the deletion.

    Without ``of_all``, the page shows one exercise at a time. Without ``forgets``, the page has no
    deletion.
    """
    # Deletion concerns all exercises and courses.
    all_of_them = [("", say("All exercises"))] if of_all else []
    titles = ((each.id, in_language(each, language).title) for each in catalogue.values())
    choices = [*all_of_them, *titles]
    return _page(
        "attempts",
        assets,
        language,
        "../",
        "attempts.js",
        choices=choices,
        forgets=forgets,
        **place._asdict(),
    )


def attempt_page(attempt_id: str, assets: Assets, language: Language) -> bytes:
    """Return the page of an attempt: the answers, their report, and the tutor's points."""
    return _page("attempt", assets, language, "../../", "attempt.js", attempt_id=attempt_id)


def statistics_page(
    exercise: Exercise, assets: Assets, language: Language, place: CoursePlace
) -> bytes:
    """Return the page with an exercise's statistics."""
    # It also has the export of attempts and the regrade.
    return _page(
        "statistics",
        assets,
        language,
        "../../",
        "statistics.js",
        exercise=in_language(exercise, language),
        **place._asdict(),
    )


def nothing_recorded_page(assets: Assets, language: Language, root: str) -> bytes:
    """Return the page that explains how to start the service with recording of attempts."""
    return _page("nothing_recorded", assets, language, root)


def _page(
    name: str, assets: Assets, language: Language, root: str, *scripts: str, **values: Any
) -> bytes:
    return page(
        f"web/tutor/templates/{name}.html",
        assets,
        root,
        ["page.js", *scripts],
        styles=["tutor.css", "records.css"],
        language=language,
        tutor=True,
        **values,
    )
