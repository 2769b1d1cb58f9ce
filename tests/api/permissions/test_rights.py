"""docs/keys.md lists the right that each route requires."""

import asyncio
import re
from collections.abc import Callable, Mapping
from pathlib import Path

import httpx
import pytest
from dh_grader.access import Scope
from dh_grader.api.application import WebPages, application
from dh_grader.api.permissions import (
    ACCESS_PROBLEMS,
    RIGHTS,
    Reach,
    access_problem,
    right_of,
    scope_missing,
)
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.load import Drafts
from dh_grader.server import installed_app
from dh_grader.settings import load_settings
from fastapi import APIRouter, FastAPI, Request
from fastapi.routing import iter_route_contexts
from starlette.routing import Route

from tests.api.permissions.rights_table import PAGE, row, with_table

# Values for the texts of all problems.
VALUES: dict[str, str | int] = {
    "reason": "The key has expired.", "allowed": "record attempts", "scope": "record",
    "seconds": 7, "number": 100, "most": 64,
}  # fmt: skip


def test_the_page_has_the_table_of_rights() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page == with_table(page), (
        "The rights have changed; run python -m tests.api.permissions.rights_table"
    )


def test_each_route_needs_the_right_on_the_page() -> None:
    lines = PAGE.read_text(encoding="utf-8").splitlines(keepends=True)
    listed = 0
    for route in RIGHTS:
        method, path = route.split(" ")
        right = right_of(Request({"type": "http", "method": method, "route": Route(path, print)}))
        # Routes that everybody may use are not on the page.
        assert (row(route, right) in lines) is (right.scope is not None), route
        listed += right.scope is not None
    assert sum(line.startswith(("| `GET /", "| `POST /")) for line in lines) == listed


def test_the_page_lists_every_problem_of_access() -> None:
    section = PAGE.read_text(encoding="utf-8").partition("## Errors\n")[2].partition("\n## ")[0]
    listed = {name: int(code) for code, name in re.findall(r"\| (\d+) \| `([a-z-]+)` \|", section)}
    assert listed.pop("store-down") == 503
    problems = {name: access_problem(name, **VALUES) for name in ACCESS_PROBLEMS}
    assert listed == {name: problem.status for name, problem in problems.items()}
    assert {problem.name for problem in problems.values()} == problems.keys()
    assert len({problem.title for problem in problems.values()}) == len(problems)
    assert len({problem.detail for problem in problems.values()}) == len(problems)


def test_a_refusal_says_how_to_be_authenticated_and_when_to_come_again() -> None:
    for name in ACCESS_PROBLEMS:
        answer = access_problem(name, **VALUES).response("/v1/grade")
        # RFC 6750, section 3: without a key, the challenge says nothing about an error.
        challenge = {"key-needed": "Bearer", "key-not-valid": 'Bearer error="invalid_token"'}
        assert answer.headers.get("WWW-Authenticate") == challenge.get(name)
        again = {"too-often": "7", "busy": "1"}
        assert answer.headers.get("Retry-After") == again.get(name)


@pytest.mark.parametrize(
    ("scope", "allowed"),
    [
        (Scope.GRADE, "have answers graded"), (Scope.RECORD, "record attempts"),
        (Scope.TUTOR, "see what tutors see"),
    ],
)  # fmt: skip
def test_the_missing_scope_is_named(scope: Scope, allowed: str) -> None:
    problem = scope_missing(scope)
    assert (problem.status, problem.name) == (403, "scope-missing")
    assert problem.detail == f"This key may not {allowed}: it has not the scope {scope.value}."


def routes_of(app: FastAPI) -> set[str]:
    return {
        f"{method} {route.path}"
        for route in iter_route_contexts(app.router.routes)
        for method in (route.methods or {"ANY"}) - {"HEAD"}
    }


def test_the_table_has_each_route_and_no_other(tmp_path: Path) -> None:
    # With a database and a secret, the service has all its routes.
    database, secret = f"sqlite:///{tmp_path}/attempts.db", "one secret of thirty letters or more"
    app = installed_app(load_settings(database=database, secret=secret))

    async def routes() -> set[str]:
        async with app.router.lifespan_context(app):
            return routes_of(app)

    assert asyncio.run(routes()) == RIGHTS.keys()


def test_a_route_without_an_entry_answers_nobody(
    catalogue: Mapping[str, Exercise], client_of: Callable[[FastAPI], httpx.Client]
) -> None:
    pages = APIRouter(prefix="/tutor")
    pages.add_api_route("/secrets", lambda: "secret")
    app = application(catalogue, pages=WebPages(pages, lambda *_: None, lambda: None, Drafts()))
    assert "GET /tutor/secrets" in routes_of(app)
    answer = client_of(app).get("/tutor/secrets")
    assert answer.status_code == 500
    assert answer.json()["type"].endswith(":failed")


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
