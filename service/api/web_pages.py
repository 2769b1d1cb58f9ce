"""The web pages of the service, as the application gets them."""

from collections.abc import Callable
from typing import NamedTuple

from fastapi import APIRouter

from service.api.http.problems import ProblemPage
from service.catalogue.drafts import Drafts


class WebPages(NamedTuple):
    """The routes of the web pages, and what the application needs of the pages.

    ``of_problem`` makes an HTML page from an error response. ``drafts`` are the exercises that
    tutors preview.
    """

    routes: APIRouter
    of_problem: ProblemPage
    close: Callable[[], None]
    drafts: Drafts
