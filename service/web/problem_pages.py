"""The pages that explain an error, with advice, in place of the requested page."""

from collections.abc import Mapping
from http import HTTPStatus
from typing import Final

from fastapi import Request
from starlette.responses import RedirectResponse, Response

from service.api.http.language import keep_language, language_of
from service.api.http.problems import ProblemError, ProblemPage
from service.translations import Language, say, template
from service.web.assets import Assets
from service.web.page_headers import PRIVATE_HEADERS
from service.web.pages import page
from service.web.sign_in import sign_in_address

# The advice to readers without a tutor's key, by the names of problems.
_FOR_TUTORS: Final[Mapping[str, str]] = {
    "scope-missing": template("{detail} This page needs a tutor's key."),
    "solutions-off": template(
        "Create a tutor's key, and sign in with it. If DH_GRADER_SOLUTIONS is false, "
        "no key opens this page."
    ),
    "attempts-not-shown": template(
        "Create a tutor's key, and sign in with it. If DH_GRADER_READ_ATTEMPTS "
        "is false, no key opens this page."
    ),
}


def problem_page(assets: Assets) -> ProblemPage:
    """Return a function that makes an HTML error page from a problem."""
    # The function returns None if the request did not ask for a page.

    def made(request: Request, problem: ProblemError) -> Response | None:
        path = request.url.path.removeprefix(request.scope.get("root_path", ""))
        accepted = request.headers.get("accept", "")
        if request.method != "GET" or path.startswith("/v1/") or "text/html" not in accepted:
            return None
        root = "../" * (path.count("/") - 1)
        if problem.status is HTTPStatus.UNAUTHORIZED:
            asking = f"{root}{sign_in_address(path, request.url.query)}"
            return RedirectResponse(
                asking, HTTPStatus.SEE_OTHER, {**PRIVATE_HEADERS, "Vary": "Accept, Cookie"}
            )
        language = language_of(request)
        response = problem.answer(_content(problem, assets, root, language))
        vary = "Accept, Accept-Language, Cookie"
        response.headers.update({**PRIVATE_HEADERS, "Content-Language": language.tag, "Vary": vary})
        keep_language(request, response)
        return response

    return made


def _content(problem: ProblemError, assets: Assets, root: str, language: Language) -> bytes:
    name, is_missing = problem.name, problem.status is HTTPStatus.NOT_FOUND
    if name in _FOR_TUTORS:
        heading: str = say("This page is for tutors")
    elif is_missing and not name:
        heading = say("Page not found")
    else:
        heading = problem.title or problem.status.phrase
    advice = _FOR_TUTORS.get(name)
    return page(
        "web/templates/problem.html",
        assets,
        root,
        ["page.js"],
        styles=["tutor.css", "records.css"],
        language=language,
        heading=heading,
        advice=say(advice, detail=problem.detail) if advice else "",
        links_to_exercises=name == "other-exercise",
        needs_database=name == "attempts-not-recorded",
        links_to_catalogue=is_missing,
        detail=problem.detail,
    )
