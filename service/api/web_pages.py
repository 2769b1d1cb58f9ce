"""The web pages of the service, as the application includes them."""

from collections.abc import Callable
from typing import NamedTuple

from fastapi import APIRouter

from service.api.http.problems import ProblemPage
from service.catalogue.drafts import Drafts


class WebPages(NamedTuple):
    """The routes of the web pages, with the functions and data that the application needs.

    ``of_problem`` makes an HTML page from an error response. ``close`` stops the work that the
    pages have started. ``drafts`` are the exercises that tutors preview in the editor.
    """

    routes: APIRouter
    of_problem: ProblemPage
    close: Callable[[], None]
    drafts: Drafts
