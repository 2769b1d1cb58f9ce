"""The page in the place of one that cannot be shown: what the reader can do."""

from collections.abc import Mapping
from http import HTTPStatus
from typing import Final

from fastapi import Request
from starlette.responses import Response

from service.api.http.problems import ProblemError, ProblemPage
from service.formats.shared.markup import Child, element
from service.web.assets import Assets
from service.web.page_headers import PRIVATE_HEADERS
from service.web.pages import page

_MAKE_KEY: Final = 'dh-grader keys create "Your name" --scope tutor'
_AS_PASSWORD: Final = "Open the page again and give the key as the password, under any name."
# What those read who have no tutor's key, by the names of problems.
_FOR_TUTORS: Final[Mapping[str, str]] = {
    "key-needed": f"This page needs a tutor's key. {_AS_PASSWORD}",
    "key-not-valid": f"{{detail}} {_AS_PASSWORD}",
    "scope-missing": f"{{detail}} This page needs a tutor's key. {_AS_PASSWORD}",
    "solutions-off": "Make a tutor's key, and give it as the password when the browser asks; no "
    "key is enough where DH_GRADER_SOLUTIONS is false.",
    "attempts-not-shown": "Make a tutor's key, and give it as the password when the browser asks; "
    "no key is enough where DH_GRADER_READ_ATTEMPTS is false.",
}


def problem_page(assets: Assets) -> ProblemPage:
    """What makes the page of a problem: with its status, and None where no page was asked for."""

    def made(request: Request, problem: ProblemError) -> Response | None:
        path = request.url.path.removeprefix(request.scope.get("root_path", ""))
        accepted = request.headers.get("accept", "")
        if request.method != "GET" or path.startswith("/v1/") or "text/html" not in accepted:
            return None
        response = problem.answer(_content(problem, assets, "../" * (path.count("/") - 1)))
        response.headers.update({**PRIVATE_HEADERS, "Vary": "Accept"})
        return response

    return made


def _content(problem: ProblemError, assets: Assets, root: str) -> bytes:
    name, is_missing = problem.name, problem.status is HTTPStatus.NOT_FOUND
    said: list[Child]
    if name in _FOR_TUTORS:
        heading = "This page is for tutors"
        said = [
            element("p", _FOR_TUTORS[name].format(detail=problem.detail)),
            element("p", "Who runs the service makes a key:"),
            element("pre", element("code", _MAKE_KEY), tabindex="0"),
        ]
    elif name == "other-exercise":
        heading = problem.title
        link = element("a", "pages of its exercises", href=f"{root}tutor")
        said = [element("p", "Open one of the ", link, ".")]
    elif is_missing:
        heading = problem.title if name else "Nothing is at this address"
        link = element("a", "list of exercises", href=root or ".")
        said = [element("p", "Choose one from the ", link, ".")]
    else:
        heading = problem.title or problem.status.phrase
        said = [element("p", problem.detail)]
    main = element(
        "main",
        element("h1", heading),
        element("section", *said, class_="empty"),
        id="main",
        class_="records",
    )
    title = f"{heading} · DH Grader"
    return page(title, main, assets, root, ["page.js"], styles=["tutor.css", "records.css"])
