"""The help pages and their routes."""

# They need no scripts.

from typing import Final

from fastapi import APIRouter, Request
from starlette.responses import RedirectResponse, Response

from service.api.http.language import keep_language, language_of
from service.api.permissions.access import Access
from service.translations import Language, say
from service.web.assets import Assets
from service.web.page_answer import page_answer
from service.web.pages import page

# The pages by their addresses, with their titles.
TOPICS: Final = {
    "expressions": say("What you may type"),
    "pasting": say("Paste a table or a matrix"),
    "points": say("How you earn points"),
}


def help_routes(assets: Assets, access: Access) -> APIRouter:
    """Return the routes of the help pages, one for each topic."""
    router = APIRouter()

    @router.get("/help")
    async def first(request: Request) -> Response:
        """Redirect to the first help page."""
        answer = RedirectResponse("help/expressions")
        keep_language(request, answer)
        return answer

    def add(topic: str) -> None:
        async def shown(request: Request) -> Response:
            tutor = access.shows_solutions(request)
            content = help_page(topic, assets, language_of(request), tutor=tutor)
            return page_answer(request, content)

        router.add_api_route(f"/help/{topic}", shown)

    for topic in TOPICS:
        add(topic)
    return router


def help_page(topic: str, assets: Assets, language: Language, *, tutor: bool = False) -> bytes:
    """Return the help page on one of the ``TOPICS``."""
    return page(
        f"web/help/templates/{topic}.html",
        assets,
        "../",
        ["page.js"],
        styles=["help.css"],
        language=language,
        tutor=tutor,
        topic=topic,
        topics=TOPICS,
    )
