"""The pages of recorded attempts as HTML: forms, and empty elements that scripts fill."""

from typing import Any, NamedTuple

from service.api.http.lookup import Catalogue
from service.catalogue import Exercise
from service.web.assets import Assets
from service.web.pages import page


class CoursePlace(NamedTuple):
    """The course and the assignment to which a page is limited; "" for no limit."""

    course: str = ""
    assignment: str = ""


def attempts_page(
    catalogue: Catalogue,
    assets: Assets,
    place: CoursePlace,
    *,
    of_all: bool = True,
    forgets: bool = True,
) -> bytes:
    """Return the page with the list of attempts, its filters, the export, and the deletion.

    Without ``of_all``, the list always shows one exercise; without ``forgets``, there is no
    deletion, because it concerns all exercises and courses.
    """
    all_of_them = [("", "All exercises")] if of_all else []
    choices = [*all_of_them, *((each.id, each.title) for each in catalogue.values())]
    return _page(
        "attempts",
        assets,
        "../",
        "attempts.js",
        choices=choices,
        forgets=forgets,
        **place._asdict(),
    )


def attempt_page(attempt_id: str, assets: Assets) -> bytes:
    """Return the page of an attempt: the answers, their report, and the points that tutors give."""
    return _page("attempt", assets, "../../", "attempt.js", attempt_id=attempt_id)


def statistics_page(exercise: Exercise, assets: Assets, place: CoursePlace) -> bytes:
    """Return the page of an exercise with the statistics of its attempts, export, and regrade."""
    return _page(
        "statistics",
        assets,
        "../../",
        "statistics.js",
        exercise=exercise,
        **place._asdict(),
    )


def nothing_recorded_page(assets: Assets, root: str) -> bytes:
    """Return the page that says how to start the service so that it records attempts."""
    return _page("nothing_recorded", assets, root)


def _page(name: str, assets: Assets, root: str, *scripts: str, **values: Any) -> bytes:
    return page(
        f"web/tutor/templates/{name}.html",
        assets,
        root,
        ["page.js", *scripts],
        styles=["tutor.css", "records.css"],
        tutor=True,
        **values,
    )
