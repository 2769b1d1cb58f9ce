"""The web pages of the service, as the interface knows them."""

from collections.abc import Callable
from typing import NamedTuple

from fastapi import APIRouter

from service.api.http.problems import ProblemPage


class WebPages(NamedTuple):
    """The routes of the pages, and the page of a problem for whoever reads in a browser.

    ``close`` ends what the pages have begun.
    """

    routes: APIRouter
    of_problem: ProblemPage
    close: Callable[[], None]
