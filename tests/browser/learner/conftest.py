"""Fixtures: a service with a course and a learner, and the course's own site."""

import re
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from http.server import ThreadingHTTPServer
from typing import Any

import pytest
from dh_grader import courses as roll
from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.keys import add_key
from dh_grader.contract.courses import LinksRequest, NewAssignment, NewCourse, NewLearner
from dh_grader.courses import issue_links
from dh_grader.courses.assignments import add_assignment
from dh_grader.store import AttemptStore
from dh_grader.store.database import in_transaction
from sqlalchemy import Connection

from tests.api.serving import ROOT, served

COURSE = "robotics-2026"
SECRET = "0123456789abcdef" * 4
ROBOT = {"exercise": "scara", "points": 10}
EXERCISES = {"scara", "scara-faded", "planar-rr-numbers"}
ASSIGNMENTS: Mapping[str, dict[str, Any]] = {
    "homework": {"limit": 2, "feedback": ["verdicts"], "due": 1},
    "late": {"due": -1, "closes": 1, "practice": "open"},
    "over": {"due": -1},
    "soon": {"opens": 1},
    "homework-1": {"limit": 3},
    "hints": {
        "exercises": [{"exercise": "scara-faded", "points": 10}],
        "hint_prices": [0, 0.05, 0.1],
        "solution": "after_full",
    },
    "own": {"exercises": [{"exercise": "planar-rr-numbers", "points": 8}], "variants": True},
}


@dataclass(frozen=True)
class Course:
    """A service with a course, a learner's link, and the course's own site."""

    address: str
    link: str
    site: str


@pytest.fixture(scope="session")
def site() -> Iterator[tuple[str, dict[str, Any]]]:
    text = (ROOT / "docs" / "embedding.md").read_text(encoding="utf-8")
    [example] = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names: dict[str, Any] = {"__name__": "course_site"}
    exec(example, names)  # noqa: S102

    handler = type("Quiet", (names["Site"],), {"log_message": lambda *_: None})
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}", names
        server.shutdown()
        thread.join()


@pytest.fixture(scope="session")
def course(
    tmp_path_factory: pytest.TempPathFactory, site: tuple[str, dict[str, Any]]
) -> Iterator[Course]:
    folder = tmp_path_factory.mktemp("course")
    database = str(folder / "attempts.db")
    store = AttemptStore.open(database)
    now = datetime.now(UTC)
    origin, names = site
    names["KEY"] = new_key_text()

    def set_up(connection: Connection) -> str:
        roll.add_course(connection, NewCourse(id=COURSE, title="Robots", zone="Asia/Tokyo"), now)
        roll.add_learners(connection, COURSE, [NewLearner(learner="u4711", name="Ada Lovelace")])
        for name, fields in ASSIGNMENTS.items():
            new = {"id": name, "title": name.title(), "exercises": [ROBOT], **fields}
            for date in {"opens", "due", "closes"} & fields.keys():
                new[date] = (now + timedelta(days=fields[date])).isoformat()
            assignment = NewAssignment.model_validate(new)
            add_assignment(connection, COURSE, assignment, EXERCISES)
        digest, until = Secret(SECRET).key_digest(names["KEY"]), now + timedelta(days=1)
        add_key(connection, "", digest, {Scope.RECORD}, None, now, until, COURSE)
        [link] = issue_links(connection, COURSE, LinksRequest(), Secret(SECRET), "", now)
        return link.link

    link = in_transaction(store.engine, set_up)
    store.close()
    variables = {
        "DH_GRADER_DATABASE": database,
        "DH_GRADER_SECRET": SECRET,
        "DH_GRADER_CORS_ORIGINS": origin,
    }
    with served(folder, **variables) as server:
        names["GRADER"] = server.address
        yield Course(server.address, server.address + link, origin)
