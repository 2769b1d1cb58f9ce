"""The web pages of the service, as the interface knows them."""

from typing import NamedTuple

from fastapi import APIRouter

from service.api.problems import ProblemPage


class WebPages(NamedTuple):
    """The routes of the pages, and the page of a problem for whoever reads in a browser."""

    routes: APIRouter
    of_problem: ProblemPage
