"""Test courses and assignments."""

import asyncio
import io
import json
import tomllib
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.key_ring import add_key, settle
from dh_grader.api.http import ARRIVED
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.cli import program
from dh_grader.client import GraderClient, RequestRefusedError
from dh_grader.contract.courses import (
    AssignmentChange,
    CourseChange,
    DealRequest,
    DeletionRequest,
    Extension,
    LearnersRequest,
    LinksRequest,
    NewAssignment,
    NewCourse,
    NewLearner,
    RemovalRequest,
    RevokeLinksRequest,
    SendAgainRequest,
)
from dh_grader.courses import CourseError, roll
from dh_grader.courses.assignments import (
    add_assignment,
    assignments_of,
    change_assignment,
    extend,
    learner_terms,
    terms_of,
)
from dh_grader.courses.gradebook import (
    _log,
    _log_missing,
    gradebook,
    handed_in,
    missing,
    written_gradebook,
)
from dh_grader.courses.roll import issue_links, revoke_links
from dh_grader.server import installed_app
from dh_grader.settings import Settings
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import in_transaction, open_database
from dh_grader.store.results import forget
from dh_grader.translations import ENGLISH
from dh_grader.web.courses import CourseState, assignment_page
from dh_grader.web.pages import load_assets
from pydantic import SecretStr
from sqlalchemy import Connection
from typer.testing import CliRunner

from tests.access.kept_services import SECRET
from tests.api.serving import served
from tests.courses.conftest import ADDRESS, NO_TWIST, NOW, RIGHT, Class, days
from tests.courses.test_gradebook import as_tutor, sheets
from tests.store.databases import KINDS

# --- Test courses: hand-ins, due dates, extensions and the gradebook


def points(class_: Class) -> list[list[float | None]]:
    return [row.points for row in class_.do(lambda it: gradebook(it, "robots")).rows]


def all_right() -> Any:
    """Return correct answers to all parts of the exercise scara."""
    file = Path(__file__).parents[2] / "exercises/scara.toml"
    return tomllib.loads(file.read_text(encoding="utf-8"))["checks"][0]["answers"]


def near(value: float) -> list[Any]:
    return [pytest.approx(value, abs=1e-5)]


BOTH = pytest.mark.parametrize("class_", KINDS, indirect=True)


@pytest.mark.long
@BOTH
def test_the_limit_holds_under_parallel_attempts_and_each_is_recorded_once(class_: Class) -> None:
    class_.assign(limit=3)
    path = "/v1/courses/robots/assignments/homework/attempts"

    async def together() -> list[int]:
        sent = [
            class_.send("POST", path, "ada", f"{i // 2}", exercise="scara", answers=NO_TWIST)
            for i in range(50)
        ]
        return [answer.status_code for answer in await asyncio.gather(*sent)]

    codes = asyncio.run(together())
    own = class_.own()
    # Every attempt was sent twice with the same key.
    assert sorted(codes) == [201] * 6 + [403] * 44
    assert (len(own["attempts"]), own["attempts_left"]) == (3, 0)
    assert class_.own("grace")["attempts_left"] == 3


@BOTH
def test_a_later_due_date_and_an_extension_give_late_attempts_their_points_back(
    class_: Class,
) -> None:
    class_.assign(due=days(-2), closes=days(2))
    for learner in ("ada", "grace"):
        assert class_.hand_in("a", learner=learner).json()["attempt"]["is_late"]
    whole = class_.own()["best"]
    assert points(class_) == [near(whole / 2)] * 2
    # An extension that ends before the attempt changes nothing.
    for due, ada in ((-1, whole / 2), (1, whole)):
        given = Extension.model_validate({"learner": "ada", "due": days(due)})
        class_.do(partial(extend, course="robots", assignment="homework", extension=given))
        assert points(class_) == [near(ada), near(whole / 2)]
    later = AssignmentChange.model_validate({"due": days(1)})
    class_.do(lambda it: change_assignment(it, "robots", "homework", later, {"scara"}))
    assert points(class_) == [near(whole)] * 2
    # An earlier due date makes no recorded attempt late.
    earlier = AssignmentChange.model_validate({"due": days(-3)})
    class_.do(lambda it: change_assignment(it, "robots", "homework", earlier, {"scara"}))
    assert points(class_) == [near(whole)] * 2


def test_learners_read_the_titles_of_exercises_in_their_language(class_: Class) -> None:
    class_.assign()
    told = class_.ask("GET", "/v1/me?lang=de")
    assert told.headers["content-language"] == "de"
    assert told.headers["cache-control"] == "no-store"
    [course] = told.json()["courses"]
    assert course["assignments"][0]["exercises"][0]["title"] == "SCARA-Roboter"
    assert class_.own()["title"] == "SCARA manipulator"


@pytest.mark.parametrize(
    ("place", "named"),
    [
        (("nothing", "homework", "ada"), "no course nothing"),
        (("robots", "homework", "nobody"), "no learner nobody"),
        (("robots", "nothing", "ada"), "no assignment nothing"),
    ],
)
def test_what_a_course_does_not_have_is_named(
    class_: Class, place: tuple[str, str, str], named: str
) -> None:
    class_.assign()
    assert class_.do(lambda it: terms_of(it, "robots", "homework", "ada")).id == "homework"
    with pytest.raises(CourseError, match=named):
        class_.do(lambda it: terms_of(it, *place))


def test_a_learner_s_assignments_are_listed_course_by_course(class_: Class) -> None:
    def second(connection: Connection) -> None:
        course = NewCourse(id="arms", title="Arms", zone="Asia/Tokyo")
        roll.add_course(connection, course, NOW)
        roll.add_learners(connection, "arms", [NewLearner(learner="ada", name="Ada")])

    class_.do(second)
    for course, name in (("robots", "a"), ("arms", "b"), ("robots", "c"), ("arms", "d")):
        exercises = [{"exercise": "scara", "points": 1}]
        fields = {"id": name, "title": name, "exercises": exercises, "due": "2027-01-01T00:00"}
        new = NewAssignment.model_validate(fields)
        class_.do(partial(add_assignment, course=course, new=new, known={"scara"}))

    def told(only: str | None) -> list[tuple[str, str, str]]:
        found = class_.do(lambda it: list(learner_terms(it, "ada", only)))
        return [(course, each.id, str(each.zone)) for course, each in found]

    arms = [("arms", name, "Asia/Tokyo") for name in "bd"]
    robots = [("robots", name, "Europe/Berlin") for name in "ac"]
    assert told(None) == [*arms, *robots]
    assert (told("arms"), told("robots")) == (arms, robots)
    assert class_.do(lambda it: list(learner_terms(it, "grace", "arms"))) == []


def test_an_extension_may_give_more_attempts(class_: Class) -> None:
    class_.assign(limit=1)
    assert [class_.hand_in(key).status_code for key in "ab"] == [201, 403]
    class_.do(lambda it: extend(it, "robots", "homework", Extension(learner="ada", limit=2)))
    assert [class_.hand_in(key).status_code for key in "bc"] == [201, 403]


def test_no_practice_while_an_exercise_counts(class_: Class) -> None:
    class_.assign(limit=3, practice="after", solution="after_full", feedback=["score", "verdicts"])
    grade = "/v1/exercises/scara/grade"
    solution = "/v1/courses/robots/assignments/homework/solutions/scara"
    submissions = [{"exercise": "scara", "answers": RIGHT}]

    def practised() -> list[object]:
        many = class_.ask("POST", "/v1/grade", submissions=submissions).json()["results"][0]
        one = class_.ask("POST", grade, answers=RIGHT)
        return [one.status_code, next(iter(many)), class_.ask("GET", solution).status_code]

    assert practised() == [403, "problem", 403]
    assert class_.hand_in("a").json()["report"]["feedback"] == "score"
    assert class_.hand_in("b").json()["report"]["feedback"] == "verdicts"
    assert practised() == [403, "problem", 403]
    parts = class_.ask("GET", "/v1/exercises/scara").json()["parts"]
    assert {each["id"] for each in parts} == {"table", "links", "pose"}
    # Points of a tutor are full marks, too.
    attempt = class_.own()["attempts"][0]["id"]
    asyncio.run(class_.store.override(attempt, 24.0, "A misprint.", "Prof. X"))
    assert practised() == [200, "report", 200]
    # Another exercise may be practised all the time.
    assert class_.ask("POST", "/v1/exercises/planar-rr/grade", answers={}).status_code == 200


def test_no_practice_before_the_assignment_opens_either(class_: Class) -> None:
    grade = "/v1/exercises/scara/grade"
    assert class_.ask("POST", grade, answers={}).status_code == 200
    class_.assign(limit=3, opens=days(1))
    assert class_.ask("POST", grade, answers={}).status_code == 403


def test_an_exercise_whose_file_is_not_there_is_named_to_learner_and_tutor(
    class_: Class, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    # The command line knows a new file, which the service has not read yet.
    exercises = [{"exercise": each, "points": 1} for each in ("scara", "brand-new")]
    fields = {"id": "homework", "title": "Homework", "exercises": exercises}
    new = NewAssignment.model_validate(fields)
    class_.do(lambda it: add_assignment(it, "robots", new, {"scara", "brand-new"}))
    # The log of uvicorn may have been set up by another test, so that pytest does not see it.
    logged: list[object] = []
    monkeypatch.setattr(_log, "warning", lambda *told: logged.extend(told))
    _log_missing.cache_clear()
    class_.own()
    [course] = class_.ask("GET", "/v1/me").json()["courses"]
    found = course["assignments"][0]["exercises"]
    assert [each["is_missing"] for each in found] == [False, True]
    assert logged[1:] == ["homework", "brand-new"]

    def drawn(connection: Any) -> str:
        [chosen] = assignments_of(connection, "robots")
        learners = roll.learners(connection, "robots", NOW)
        state = CourseState(roll.course(connection, "robots"), learners, [chosen], {}, None)
        book = gradebook(connection, "robots")
        page = assignment_page(state, chosen, [], book, [], catalogue, load_assets(), ENGLISH)
        return page.decode()

    page = class_.do(drawn)
    assert page.count("This service does not have the exercise") == 1
    assert "brand-new, which this service does not have" in page
    # The form cannot drop it silently.
    body = {"exercises": [{"exercise": "brand-new", "points": 1}]}
    path = "/v1/courses/robots/assignments/homework"
    refused = as_tutor(class_, None).ask("POST", path, "tutor", **body)
    assert refused.status_code == 422
    assert "DH_GRADER_RELOAD_EXERCISES=true" in refused.json()["detail"]


def test_all_lists_have_the_order_of_family_names(class_: Class) -> None:
    class_.assign()
    people = [
        NewLearner(learner="ada", name="Ada Lovelace", family_name="Lovelace"),
        NewLearner(learner="grace", name="Grace Hopper", family_name="Hopper"),
        NewLearner(learner="u3", name="Ängström, Zoë"),
    ]
    class_.do(lambda it: roll.add_learners(it, "robots", people))
    names = ["u3", "grace", "ada"]
    assert [each.learner for each in class_.do(lambda it: gradebook(it, "robots")).rows] == names
    absent = class_.do(lambda it: missing(it, "robots", "homework"))
    assert [each.learner for each in absent] == names
    tutor = as_tutor(class_, None)
    listed = tutor.ask("GET", "/v1/courses/robots/learners", "tutor").json()["learners"]
    assert [each["learner"] for each in listed] == names
    assert "family_name" not in tutor.ask("GET", "/v1/courses/robots/gradebook", "tutor").text


def test_an_exercise_with_the_same_robot_is_no_practice_either(class_: Class) -> None:
    # Practice with another exercise on the same robot would give away the assigned table.
    def practised(exercise: str) -> list[int]:
        paths = [f"/v1/exercises/{exercise}/{last}" for last in ("grade", "solution")]
        return [class_.ask("POST", path, answers={}).status_code for path in paths]

    # Empty answers have no full marks.
    assert practised("scara-faded") == [200, 403]
    class_.assign(limit=3, solution="after_due", due=days(1))
    answer = class_.ask("POST", "/v1/exercises/find-the-slip-scara/grade", answers={}).json()
    assert answer["type"] == "urn:dh-grader:problem:no-practice"
    assert "scara has the same robot" in answer["detail"]
    assert practised("scara-faded") == [403, 403]
    assert practised("planar-rrr") == [200, 403]
    refused = class_.ask("POST", "/v1/exercises/scara-faded/solution", answers={}).json()
    assert refused["detail"] == "An assignment does not show you this solution now."
    # The terms of an assignment with the exercise itself come first.
    exercises = [{"exercise": "scara-faded", "points": 1}]
    fields = {"id": "warm-up", "title": "Warm-up", "exercises": exercises, "practice": "open"}
    new = NewAssignment.model_validate(fields)
    class_.do(lambda it: add_assignment(it, "robots", new, {"scara-faded"}))
    assert practised("scara-faded") == [200, 403]
    assert practised("find-the-slip-scara") == [403, 403]


def test_attempts_outside_of_the_assignment_are_no_practice_either(class_: Class) -> None:
    class_.assign(limit=1, practice="none")
    text, scopes, until = new_key_text(), {Scope.GRADE, Scope.RECORD}, NOW + timedelta(days=1)
    digest = SECRET.key_digest(text)
    class_.do(lambda it: add_key(it, "site", digest, scopes, None, NOW, until))
    site = replace(class_, keys={"site": text})
    token = site.ask("POST", "/v1/tokens", "site", learner="ada").json()["token"]
    ada = replace(class_, keys={"ada": token})
    for exercise, status in (("scara", 403), ("planar-rr", 201)):
        path = f"/v1/exercises/{exercise}/attempts"
        assert ada.ask("POST", path, answers={}, learner="ada").status_code == status


def test_waiting_for_a_turn_makes_no_hand_in_late(class_: Class) -> None:
    # A busy service gets a request before the due date, and grades it after the due date.
    class_.assign(due=(NOW + timedelta(minutes=-1)).isoformat())
    inner = class_.app

    async def waited(scope: Any, receive: Any, send: Any) -> None:
        await inner({**scope, ARRIVED: NOW - timedelta(minutes=minutes)}, receive, send)

    class_.app = waited
    minutes = 2
    attempt = class_.hand_in("a").json()["attempt"]
    assert attempt["is_late"] is False
    assert datetime.fromisoformat(attempt["at"]) == NOW - timedelta(minutes=2)
    minutes = 0
    assert class_.hand_in("b").json()["type"].endswith("closed")


@pytest.mark.sampled(2)
@pytest.mark.parametrize("late_worth", [0, 1e-7, 0.3, 1])
def test_a_late_attempt_has_full_marks_before_the_deduction(
    class_: Class, late_worth: float
) -> None:
    terms = {"solution": "after_full", "practice": "after", "late_worth": late_worth}
    class_.assign(due=days(1), closes=days(3), **terms)
    class_.do(
        lambda it: change_assignment(
            it, "robots", "homework", AssignmentChange.model_validate({"due": days(-1)}), {"scara"}
        )
    )
    assert class_.hand_in("a").json()["attempt"]["is_late"]
    own = class_.own()
    assert not own["shows_solution"]
    assert own["best"] > 1
    class_.hand_in("b", all_right())
    own = class_.own()
    assert (own["earned"], own["best"]) == (pytest.approx(10 * late_worth, abs=1e-5), 10)
    assert (own["shows_solution"], own["may_practise"]) == (True, True)
    path = "/v1/courses/robots/assignments/homework/solutions/scara"
    assert class_.ask("GET", path).status_code == 200


@BOTH
def test_a_link_is_for_one_learner_of_one_course_and_can_be_ended(class_: Class) -> None:
    class_.assign()
    path = "/v1/courses/robots/assignments/homework/attempts"
    other = class_.ask("POST", path, "ada", "a", exercise="scara", answers={}, learner="grace")
    assert other.json()["type"].endswith("other-learner")
    alone = class_.ask("POST", "/v1/exercises/scara/attempts", answers={}, learner="ada")
    assert alone.json()["type"].endswith("other-course")
    first = class_.hand_in("a").json()["attempt"]["id"]
    assert class_.ask("GET", f"/v1/attempts/{first}", "grace").status_code == 404
    again = LinksRequest(learners=["ada"])
    [same] = class_.do(lambda it: issue_links(it, "robots", again, SECRET, ADDRESS, NOW))
    assert same.link == f"{ADDRESS}/learn#{class_.keys['ada']}"
    renewed = LinksRequest(learners=["ada"], renew=True)
    [new] = class_.do(lambda it: issue_links(it, "robots", renewed, SECRET, ADDRESS, NOW))
    old, keys = class_.keys["ada"], {**class_.keys, "ada": new.link.partition("#")[2]}
    assert old not in new.link
    class_.keys = keys
    # The same attempt, sent again with the new link, is recorded once.
    assert class_.hand_in("a").json()["attempt"]["id"] == first
    assert class_.do(lambda it: revoke_links(it, "robots", ["ada"], NOW)) == 1
    nobody = LinksRequest(learners=["nobody"])
    with pytest.raises(CourseError, match="no learner nobody"):
        class_.do(lambda it: issue_links(it, "robots", nobody, SECRET, ADDRESS, NOW))


@BOTH
def test_the_gradebook_and_who_is_missing(class_: Class) -> None:
    class_.assign()
    class_.hand_in("a")
    best = class_.hand_in("b", RIGHT).json()["attempt"]
    share = round(10 * best["points"] / best["max_points"], 6)
    assert points(class_) == [[share], [None]]
    absent = class_.do(lambda it: missing(it, "robots", "homework"))
    assert [(each.learner, each.exercises) for each in absent] == [("grace", ["scara"])]
    # What counts is the learner's own dates.
    dates = {"due": days(1), "closes": days(3)}
    change = AssignmentChange.model_validate(dates)
    class_.do(lambda it: change_assignment(it, "robots", "homework", change, ()))
    for own, told in (
        ({}, dates),
        ({"closes": days(5)}, {**dates, "closes": days(5)}),
        ({"due": days(4)}, {"due": days(4), "closes": days(4)}),
    ):
        extension = Extension.model_validate({"learner": "grace", **own})
        class_.do(partial(extend, course="robots", assignment="homework", extension=extension))
        [grace] = class_.do(lambda it: missing(it, "robots", "homework"))
        assert {"due": grace.due, "closes": grace.closes} == {
            name: datetime.fromisoformat(date) for name, date in told.items()
        }
    book = class_.do(lambda it: gradebook(it, "robots"))
    moodle = b"".join(written_gradebook(book, "moodle")).decode().splitlines()
    assert moodle[0] == "ID number,Full name,Email address,homework scara"
    assert moodle[2] == "grace,Grace,,"
    canvas = b"".join(written_gradebook(book, "canvas")).decode().splitlines()
    assert canvas[1] == "    Points Possible,,,,,10"
    [attempt] = [each for each in class_.own()["attempts"] if each["counts"]]
    assert attempt["id"] == best["id"]


@BOTH
def test_an_attempt_in_which_nothing_could_be_read_counts_nowhere(class_: Class) -> None:
    class_.assign(limit=1, due=days(1))
    unread = class_.hand_in("a", {"table": "???"}).json()["attempt"]
    tutor = as_tutor(class_)

    def told() -> list[Any]:
        absent = class_.do(lambda it: missing(it, "robots", "homework"))
        book = tutor.ask("GET", "/v1/courses/robots/gradebook?format=xlsx", "tutor")
        [_, ada, _] = sheets(book.content)["Hand-ins"]
        learners = [each.learner for each in absent]
        return [points(class_), learners, class_.do(lambda it: handed_in(it, "robots")), ada[3:4]]

    assert told() == [[[None], [None]], ["ada", "grace"], {}, []]
    # A tutor's points make it count.
    asyncio.run(class_.store.override(unread["id"], 12.0, "Handed in on paper.", "Prof. X"))
    assert told() == [[[5.0], [None]], ["grace"], {"homework": 1}, [1.0]]


def test_between_due_date_and_closing_date_no_learner_sees_the_solution(class_: Class) -> None:
    class_.assign(due=days(-1), closes=days(1), solution="after_due")
    path = "/v1/courses/robots/assignments/homework/solutions/scara"
    assert class_.ask("GET", path).status_code == 403
    assert not class_.own()["shows_solution"]
    closed = AssignmentChange.model_validate({"due": days(-2), "closes": days(-1)})
    class_.do(lambda it: change_assignment(it, "robots", "homework", closed, {"scara"}))
    assert class_.ask("GET", path).status_code == 200
    assert class_.own()["shows_solution"]


def test_a_forgotten_learner_is_in_no_course_and_has_no_link(class_: Class) -> None:
    class_.assign()
    class_.hand_in("a")
    class_.do(lambda it: extend(it, "robots", "homework", Extension(learner="ada", limit=2)))
    class_.do(lambda it: forget(it, "ada"))
    listed = class_.do(lambda it: roll.learners(it, "robots", NOW))
    assert [each.learner for each in listed] == ["grace"]
    [assignment] = class_.do(lambda it: assignments_of(it, "robots"))
    assert assignment.extensions == []
    assert class_.do(lambda it: revoke_links(it, "robots", ["ada"], NOW)) == 0


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"due": "2026-03-29T02:30"}, "never show"),
        ({"due": days(2), "closes": days(1)}, "in this order"),
        ({"closes": days(1)}, "needs due"),
        ({"exercises": [{"exercise": "nothing", "points": 1}]}, "no exercise nothing"),
        ({"exercises": [{"exercise": "scara", "points": 1}] * 2}, "twice"),
    ],
)
def test_an_unusable_assignment_is_refused(
    class_: Class, fields: dict[str, object], reason: str
) -> None:
    with pytest.raises(CourseError, match=reason):
        class_.assign(**json.loads(json.dumps(fields)))


def test_attempts_outside_of_assignments_have_the_limit_of_the_exercise_file(class_: Class) -> None:
    class_.assign(limit=1)
    class_.hand_in("a")
    outside = asyncio.run(class_.store.standing("scara", "ada", "", None))
    assert (outside.counted, outside.last) == (0, 1)


@pytest.mark.long
@pytest.mark.parametrize(
    ("public_url", "begin"),
    [
        ("https://grader.example.edu/robotics/", "https://grader.example.edu/robotics/learn#dhg_"),
        (None, "http://other.example/learn#dhg_"),
    ],
)
def test_links_begin_with_the_public_address(
    tmp_path: Path, public_url: str | None, begin: str
) -> None:
    settings = Settings(
        database=SecretStr(str(tmp_path / "a.db")),
        secret=SecretStr("s" * 40),
        public_url=public_url,
    )
    engine = open_database(str(tmp_path / "a.db"))
    text, until = new_key_text(), NOW + timedelta(days=1)
    digest = Secret("s" * 40).key_digest(text)

    def set_up(connection: Connection) -> None:
        settle(connection, Secret("s" * 40), NOW)
        add_key(connection, "tutor", digest, {Scope.TUTOR}, None, NOW, until)
        roll.add_course(connection, NewCourse(id="robots", title="Robots", zone="UTC"), NOW)
        roll.add_learners(connection, "robots", [NewLearner(learner="ada", name="Ada")])

    in_transaction(engine, set_up)
    engine.dispose()
    app = installed_app(settings)

    async def asked() -> tuple[httpx.Response, httpx.Response]:
        headers = {"authorization": f"Bearer {text}", "host": "other.example"}
        transport = httpx.ASGITransport(app)
        async with (
            app.router.lifespan_context(app),
            httpx.AsyncClient(transport=transport, base_url=ADDRESS) as client,
        ):
            return (
                await client.post("/v1/courses/robots/links", json={}, headers=headers),
                await client.post("/tutor/courses/robots/links.csv", headers=headers),
            )

    answer, page = asyncio.run(asked())
    assert answer.json()["links"][0]["link"].startswith(begin)
    assert f",{begin}" in page.text


# --- The client has a working method for every route of courses

_CHOSEN = [{"exercise": "scara", "points": 10}]
CLIENT_METHODS_SECRET = "0123456789abcdef" * 4


def administrator(database: str) -> str:
    store, text, now = AttemptStore.open(database), new_key_text(), datetime.now(UTC)
    digest, until = Secret(CLIENT_METHODS_SECRET).key_digest(text), now + timedelta(days=1)
    in_transaction(
        store.engine, lambda it: add_key(it, "", digest, [Scope.TUTOR], None, now, until)
    )
    store.close()
    return text


@pytest.mark.long
def test_every_route_of_courses_has_a_method(tmp_path: Path) -> None:
    database = str(tmp_path / "attempts.db")
    key = administrator(database)
    new = NewAssignment.model_validate({"id": "hw", "title": "H", "exercises": _CHOSEN})
    options = {"DH_GRADER_DATABASE": database, "DH_GRADER_SECRET": CLIENT_METHODS_SECRET}
    with served(tmp_path, **options) as server, GraderClient(server.address, key) as tutor:
        tutor.create_course(NewCourse(id="robots", title="Robots", zone="Europe/Berlin"))
        assert tutor.change_course("robots", CourseChange(title="Arms")).title == "Arms"
        assert tutor.course("robots").zone == "Europe/Berlin"
        # An id may have characters that an address reserves.
        people = tutor.add_learners("robots", LearnersRequest(csv="id,name\na/?1,Ada\nu2,Grace\n"))
        assert (people.listed, people.added) == (2, 2)
        assert people.learners == tutor.learners("robots").learners
        tutor.create_assignment("robots", new)
        later = Extension.model_validate({"learner": "a/?1", "limit": 7})
        assert tutor.extend("robots", "hw", later).extensions[0].limit == 7
        change = AssignmentChange(solution="after_due", title="Homework")
        assert tutor.change_assignment("robots", "hw", change) == tutor.assignment("robots", "hw")
        varied = {"exercise": "planar-rr-numbers", "points": 2}
        both = AssignmentChange.model_validate({"exercises": [*_CHOSEN, varied], "variants": True})
        tutor.change_assignment("robots", "hw", both)
        wanted = DealRequest(learner="a/?1", exercise="planar-rr-numbers")
        dealt = tutor.deal_variant("robots", "hw", wanted)
        assert tutor.variants("robots", "hw", "a/?1").variants == [dealt]
        assert tutor.exercise(dealt.variant).title
        tutor.change_assignment("robots", "hw", AssignmentChange(exercises=new.exercises))
        links = {each.learner: each.link for each in tutor.links("robots", LinksRequest()).links}
        with GraderClient(server.address, links["a/?1"].partition("#")[2]) as ada:
            made = ada.hand_in("robots", "hw", "scara", NO_TWIST, idempotency_key="1")
            assert made == ada.hand_in("robots", "hw", "scara", NO_TWIST, idempotency_key="1")
            own = ada.own_courses().courses
            with pytest.raises(RequestRefusedError) as refused:
                ada.assigned_solution("robots", "hw", "scara")
            assert refused.value.code == "solution-not-shown"
            past = {"due": datetime.now(UTC) - timedelta(days=1), "closes": None}
            tutor.change_assignment("robots", "hw", AssignmentChange.model_validate(past))
            assert ada.assigned_solution("robots", "hw", "scara").exercise == "scara"
        [left] = tutor.missing("robots", "hw").missing
        assert left.name == "Grace"
        seen = tutor.learner_view("robots", "a/?1").courses
        assert (
            seen[0].assignments[0].exercises[0].attempts
            == own[0].assignments[0].exercises[0].attempts
        )
        [ada_, grace] = tutor.gradebook("robots", "hw").rows
        assert ada_.points[0] == pytest.approx(ada_.total)
        assert grace.points == [None]
        workbook = tutor.gradebook_file("robots", "xlsx")
        assert "xl/workbook.xml" in zipfile.ZipFile(io.BytesIO(workbook)).namelist()
        assert tutor.gradebook_file("robots", "csv", "hw").startswith(b"learner,name,email,")
        with pytest.raises(RequestRefusedError):
            tutor.gradebook("robots", "none")
        assert tutor.scores("robots", "hw", "u2", failed=True).scores == []
        assert tutor.send_scores("robots", SendAgainRequest(assignment="hw")).queued == 0
        assert tutor.regrade("scara", course="robots").regraded == 0
        assert tutor.revoke_links("robots", RevokeLinksRequest(learners=["u2"])).revoked == 1
        removal = RemovalRequest(learner="u2", apply=True)
        assert tutor.remove_learner("robots", removal).deleted
        every = DeletionRequest(apply=True, with_attempts=True)
        assert not tutor.delete_course("robots", DeletionRequest()).deleted
        assert tutor.delete_assignment("robots", "hw", every).attempts == 1
        assert tutor.assignments("robots").assignments == []
        assert tutor.delete_course("robots", every).learners == 1
        assert tutor.courses().courses == []


# --- Create an assignment from a file or options, or refuse it with a reason

FILE = """
title = "Homework 5"
feedback = "verdicts"

[[exercises]]
id = "scara"
points = 30
"""
OWN = '[[exercises]]\npath = "{path}"\n'


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("", ""),
        ('[[exercises]]\nid = "planar-rr"\nparts = ["table"]\n', "planar-rr: an assignment of a"),
        (OWN, "planar-rrr: an assignment of a course has whole exercises"),
        ('[[exercises]]\nid = "no-such"\n', "no-such"),
    ],
)
def test_an_assignment_file_is_taken_whole_or_refused(
    class_: Class, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, more: str, said: str
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    own = tmp_path / "planar-rrr.toml"
    shipped = Path(__file__).parents[2] / "exercises/planar-rrr.toml"
    own.write_bytes(shipped.read_bytes())
    file = tmp_path / "homework.toml"
    file.write_text(FILE + more.format(path=own.name), encoding="utf-8")
    words = ["courses", "assignments", "add", "robots", "homework-5", "--file", str(file)]
    told = CliRunner().invoke(program, words)
    assert told.exit_code == (2 if said else 0), told.output
    assert said in " ".join(told.output.split())
    if not said:
        assert "homework-5: Homework 5, 30 points" in told.output
        assert "feedback verdicts" in told.output
    listed = CliRunner().invoke(program, ["courses", "assignments", "list", "robots"]).output
    assert ("homework-5" in listed) is (said == "")


@pytest.mark.long
def test_an_assignment_file_may_set_variants(
    class_: Class, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    file = tmp_path / "homework.toml"
    varied = '[[exercises]]\nid = "planar-rr-numbers"\n'
    file.write_text(f'title = "Numbers"\nvariants = true\n{varied}', encoding="utf-8")
    add = ["courses", "assignments", "add", "robots"]
    done = CliRunner().invoke(program, [*add, "one", "--file", str(file)])
    assert "each learner has variants of their own" in done.output
    done = CliRunner().invoke(program, [*add, "two", "--file", str(file), "--no-variants"])
    assert "Numbers" in done.output
    assert "variants" not in done.output
    checked = CliRunner().invoke(program, ["assignments", "check", str(file)])
    assert "each learner has variants of their own" in checked.output


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            ["--exercise", "scara=10", "--due", "15.10.2026"],
            "This must be a date, such as 2026-12-01",
        ),
        (["--exercise", "skara=10"], "There is no exercise skara. Did you mean scara?"),
    ],
)
def test_a_mistyped_assignment_is_refused_with_advice(
    class_: Class, monkeypatch: pytest.MonkeyPatch, options: list[str], said: str
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    words = ["courses", "assignments", "add", "robots", "hw", "--title", "Homework", *options]
    told = CliRunner().invoke(program, words)
    assert told.exit_code == 2
    assert said in " ".join(told.output.split())


@pytest.mark.long
def test_the_command_says_when_a_service_reads_a_new_file(
    class_: Class, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    folder = tmp_path / "own"
    folder.mkdir()
    text = (shipped_folder() / "planar-rr.toml").read_text(encoding="utf-8")
    (folder / "brand-new.toml").write_text(text, encoding="utf-8")
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", f"{folder}:shipped")
    add = ["courses", "assignments", "add", "robots"]
    said = CliRunner().invoke(program, [*add, "one", "--exercise", "brand-new=3"]).output
    assert "brand-new: if the file is new, restart the service." in said
    assert "restart" not in CliRunner().invoke(program, [*add, "two", "--exercise", "scara"]).output
    monkeypatch.setenv("DH_GRADER_RELOAD_EXERCISES", "true")
    said = CliRunner().invoke(program, [*add, "three", "--exercise", "brand-new=3"]).output
    assert "restart" not in said


@pytest.mark.long
def test_the_command_says_which_rules_have_no_effect(
    class_: Class, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    add = ["courses", "assignments", "add", "robots", "hw", "--exercise", "scara", "--variants"]
    said = CliRunner().invoke(program, [*add, "--due", "2026-10-15 23:59"]).output
    assert "no late attempts" in said
    assert "but not in scara: no variants there" in said
    change = ["courses", "assignments", "change", "robots", "hw"]
    said = CliRunner().invoke(program, [*change, "--closes", "2026-10-17 23:59"]).output
    assert "late attempts earn 50%" in said
    said = CliRunner().invoke(program, [*change, "--closes", "none", "--due", "none"]).output
    assert "no due date" in said
