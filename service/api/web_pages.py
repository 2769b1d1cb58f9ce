"""The interface between the application and the web pages."""

from collections.abc import Callable
from typing import NamedTuple

from fastapi import APIRouter

from service.api.http.problems import ProblemPage
from service.catalogue.drafts import Drafts


class WebPages(NamedTuple):
    """The routes of the web pages, with functions and data for the application.

    ``of_problem`` makes an HTML page from an error response. ``drafts`` are the exercises that
    tutors preview.
    """

    routes: APIRouter
    of_problem: ProblemPage
    close: Callable[[], None]
    drafts: Drafts
