"""docs/keys.md lists the right that each route requires."""

import re
from collections.abc import Callable, Mapping

import httpx
import pytest
from fastapi import APIRouter, FastAPI, Request

from service.api.application import application
from service.api.permissions.access_problems import ACCESS_PROBLEMS
from service.api.permissions.rights import Reach
from service.api.web_pages import WebPages
from service.catalogue import Exercise
from service.catalogue.drafts import Drafts
from tests.api.permissions.rights_table import PAGE, with_table


def test_the_page_has_the_table_of_rights() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page == with_table(page), (
        "The rights have changed; run python -m tests.api.permissions.rights_table"
    )


def test_the_page_lists_every_problem_of_access() -> None:
    section = PAGE.read_text(encoding="utf-8").partition("## Errors\n")[2].partition("\n## ")[0]
    listed = {name: int(code) for code, name in re.findall(r"\| (\d+) \| `([a-z-]+)` \|", section)}
    assert listed.pop("store-down") == 503
    assert listed == {name: problem.status for name, problem in ACCESS_PROBLEMS.items()}


def test_a_route_without_an_entry_prevents_startup(catalogue: Mapping[str, Exercise]) -> None:
    pages = APIRouter(prefix="/tutor")
    pages.add_api_route("/secrets", lambda: "secret")
    with pytest.raises(LookupError, match="GET /tutor/secrets"):
        application(catalogue, pages=WebPages(pages, lambda *_: None, lambda: None, Drafts()))


def test_the_exercise_of_a_right_is_that_of_the_route(
    client_of: Callable[[FastAPI], httpx.Client],
) -> None:
    # If a query names several exercises, both the right and the route use the last exercise.
    app = FastAPI()

    @app.get("/{exercise_id}")
    def named(request: Request, exercise_id: str, exercise: str | None = None) -> list[object]:
        checked = [each.named(request) for each in (Reach.PATH, Reach.QUERY, Reach.ALL, Reach.OWN)]
        return [checked, exercise_id, exercise]

    client = client_of(app)
    for query in ("", "?exercise=a", "?exercise=a&exercise=b", "?exercise=b;exercise=a"):
        [path, of_query, *none], exercise_id, exercise = client.get(f"/scara{query}").json()
        assert (path, of_query, none) == (exercise_id, exercise, [None, None])
