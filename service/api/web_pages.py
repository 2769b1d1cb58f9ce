"""The web pages of the service, as the application includes them."""

from collections.abc import Callable
from typing import NamedTuple

from fastapi import APIRouter

from service.api.http.problems import ProblemPage
from service.catalogue.drafts import Drafts


class WebPages(NamedTuple):
    """The routes of the pages, and ``of_problem``, which makes an HTML page from a problem.

    ``close`` stops the work that the pages have started. ``drafts`` are the exercises in the
    preview of the editor.
    """

    routes: APIRouter
    of_problem: ProblemPage
    close: Callable[[], None]
    drafts: Drafts
