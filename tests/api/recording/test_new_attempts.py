import asyncio
import json
import re
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import Learner
from dh_grader.grading import GradedAnswers, Submission, graded_answers
from dh_grader.store.attempt_store import AttemptStore
from fastapi import FastAPI
from pydantic import TypeAdapter, ValidationError
from sqlalchemy import text

RIGHT = {"table": "a1 0 0 θ1\na2 180deg 0 θ2\n0 0 d3 0\n0 0 d4 θ4"}
WRONG = {"table": "a1 0 0 θ1\na2 0 0 θ2\n0 0 d3 0\n0 0 d4 θ4"}
UNREADABLE = {"table": "?!"}


@pytest.fixture
def store(tmp_path: Path) -> Iterator[AttemptStore]:
    store = AttemptStore.open(str(tmp_path / "attempts.db"))
    store.start()
    yield store
    store.close()


class Course:
    """A course whose learners post attempts at one exercise."""

    def __init__(self, client: httpx.Client) -> None:
        self._client = client

    def post(
        self, answers: Mapping[str, Any], learner: str = "ada", key: str | None = None, **more: Any
    ) -> httpx.Response:
        headers = {} if key is None else {"Idempotency-Key": key}
        body = {"answers": answers, "learner": learner, **more}
        return self._client.post("/v1/exercises/scara/attempts", json=body, headers=headers)


@pytest.fixture
def course_of(catalogue: Mapping[str, Exercise], store: AttemptStore, client_of: Any) -> Any:
    def make(levels: tuple[FeedbackLevel, ...] = (FeedbackLevel.HINTS,), **rules: Any) -> Course:
        exercise = replace(
            catalogue["scara"], feedback_by_attempt=levels, attempts=AttemptsSpec(**rules)
        )
        return Course(client_of(application({"scara": exercise}, store=store)))

    return make


def count(store: AttemptStore) -> int:
    with store.engine.connect() as connection:
        return int(connection.scalar(text("SELECT COUNT(*) FROM attempts")) or 0)


def problem(response: httpx.Response) -> tuple[int, str]:
    return response.status_code, response.json()["type"].rpartition(":")[2]


def test_an_attempt_has_the_report_of_a_grading(course_of: Any, client: httpx.Client) -> None:
    response = course_of().post(WRONG)
    assert response.status_code == 201
    graded = client.post("/v1/exercises/scara/grade", json={"answers": WRONG}).json()
    recorded = response.json()
    assert recorded["report"] == graded
    assert recorded["attempt"]["points"] == graded["points"]
    assert recorded["attempt"]["ordinal"] == 1


def test_a_request_sent_again_is_answered_like_the_first(
    course_of: Any, store: AttemptStore
) -> None:
    course = course_of(limit=1)
    first, again = course.post(WRONG, key="k"), course.post(WRONG, key="k")
    assert first.content == again.content
    assert again.status_code == 201
    assert count(store) == 1
    assert problem(course.post(RIGHT, key="k")) == (422, "idempotency-key-reused")
    assert problem(course.post(WRONG, "grace", key="k")) == (422, "idempotency-key-reused")
    assert count(store) == 1


@pytest.mark.long
def test_only_readable_attempts_count(course_of: Any) -> None:
    course = course_of(limit=2)
    ordinals = [
        course.post(answers).json()["attempt"].get("ordinal")
        for answers in (UNREADABLE, WRONG, UNREADABLE, WRONG)
    ]
    assert ordinals == [None, 1, None, 2]
    assert problem(course.post(WRONG)) == (403, "no-attempts-left")
    assert course.post(WRONG, "grace").status_code == 201


@pytest.mark.long
def test_each_report_has_the_level_of_its_attempt(course_of: Any) -> None:
    course = course_of((FeedbackLevel.SCORE, FeedbackLevel.VERDICTS, FeedbackLevel.HINTS))
    levels = [course.post(WRONG).json()["report"]["feedback"] for _ in range(4)]
    assert levels == ["score", "verdicts", "hints", "hints"]
    assert course.post(WRONG, feedback="score").json()["report"]["feedback"] == "score"
    assert course.post(WRONG, feedback="full").json()["report"]["feedback"] == "hints"


def test_outcomes_have_their_codes_at_every_level(course_of: Any, store: AttemptStore) -> None:
    course_of((FeedbackLevel.SCORE,)).post(WRONG)
    with store.engine.connect() as connection:
        content = connection.scalar(text("SELECT content FROM outcomes"))
    assert content is not None
    table = json.loads(content)["table"]
    assert table["cells"]["2/alpha"] == "incorrect"
    assert table["codes"]


@pytest.fixture
def gradings(monkeypatch: pytest.MonkeyPatch) -> list[FeedbackLevel]:
    done: list[FeedbackLevel] = []

    def counted(exercise: Exercise, submission: Submission) -> GradedAnswers:
        done.append(submission.feedback)
        return graded_answers(exercise, submission)

    monkeypatch.setattr("dh_grader.store.graded_answers", counted)
    return done


@pytest.mark.sampled(3)
@pytest.mark.parametrize("level", ["hints", "verdicts", "score"])
def test_an_attempt_is_graded_once_and_told_as_by_a_grading(
    course_of: Any, client: httpx.Client, gradings: list[FeedbackLevel], level: str
) -> None:
    answers = {"table": "a1 0 0 θ1\na2 ?! 0 θ2\n0 0 d3 0\n0 0 d4 1"}
    body = {"answers": answers, "feedback": level}
    recorded = course_of().post(**body).json()["report"]
    assert recorded == client.post("/v1/exercises/scara/grade", json=body).json()
    assert len(gradings) == 1


@pytest.mark.sampled(2)
@pytest.mark.parametrize("first", [FeedbackLevel.SCORE, FeedbackLevel.FULL])
def test_attempts_at_the_same_moment_get_a_number_each_and_none_is_graded_in_vain(
    first: FeedbackLevel,
    catalogue: Mapping[str, Exercise],
    store: AttemptStore,
    gradings: list[FeedbackLevel],
) -> None:
    # Two replicas get twelve attempts at once, and first grade each as the first attempt.
    levels = (first, FeedbackLevel.VERDICTS, FeedbackLevel.HINTS)
    exercise = replace(
        catalogue["scara"], feedback_by_attempt=levels, attempts=AttemptsSpec(limit=10)
    )
    another = AttemptStore.open(str(store.engine.url.database))
    another.start()
    apps = [application({"scara": exercise}, store=each) for each in (store, another)]
    body = {"answers": WRONG, "learner": "ada"}

    async def post(app: FastAPI) -> httpx.Response:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            return await client.post("/v1/exercises/scara/attempts", json=body)

    async def all_at_once() -> list[httpx.Response]:
        return await asyncio.gather(*(post(apps[i % 2]) for i in range(12)))

    answers = asyncio.run(all_at_once())
    another.close()
    taken = [answer.json() for answer in answers if answer.status_code == 201]
    told = sorted((each["attempt"]["ordinal"], each["report"]["feedback"]) for each in taken)
    assert told == [(i + 1, str(levels[min(i, 2)])) for i in range(10)]
    assert {problem(each) for each in answers if each.status_code != 201} == {
        (403, "no-attempts-left")
    }
    # All of them are first graded as a first attempt; lower levels reuse that grading.
    anew = 11 if first is FeedbackLevel.FULL else 0
    assert len(gradings) <= 12 + anew


@pytest.mark.long
def test_a_late_attempt_is_recorded_with_its_share(course_of: Any) -> None:
    now = datetime.now(UTC)
    rules = {"due": now - timedelta(hours=1), "closes": now + timedelta(hours=1)}
    recorded = course_of(**rules, late_worth=0.5).post(RIGHT).json()
    assert recorded["attempt"]["is_late"]
    assert recorded["attempt"]["points"] == recorded["report"]["points"] / 2
    assert problem(course_of(due=now - timedelta(hours=1)).post(RIGHT)) == (403, "closed")
    assert problem(course_of(opens=now + timedelta(hours=1)).post(RIGHT)) == (403, "not-open")


def test_without_a_database_nothing_is_recorded(client: httpx.Client) -> None:
    body = {"answers": RIGHT, "learner": "ada"}
    response = client.post("/v1/exercises/scara/attempts", json=body)
    assert problem(response) == (404, "attempts-not-recorded")


def test_while_the_database_is_down_grading_goes_on(course_of: Any, store: AttemptStore) -> None:
    course = course_of()
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE attempts RENAME TO hidden"))
    refused = course.post(RIGHT)
    assert problem(refused) == (503, "store-down")
    assert int(refused.headers["Retry-After"]) > 0
    graded = course._client.post("/v1/exercises/scara/grade", json={"answers": RIGHT})
    assert graded.status_code == 200


@pytest.mark.long
@pytest.mark.parametrize(
    "learner",
    [
        "",
        "a\nb",
        "\x00",
        7,
        None,
        "x" * 201,
        "a\x85",
        "a\u2029",
        " a",
        "a ",
        "a  b",
        "\u3164",
        "a\ufe0f",
    ],
)
def test_a_learner_is_a_short_line_of_text(course_of: Any, learner: Any) -> None:
    assert problem(course_of().post(RIGHT, learner)) == (422, "invalid-request")


@pytest.mark.long
def test_a_learner_may_have_any_letters(course_of: Any) -> None:
    for learner in ("Ада Лавлейс", "ada@example.edu", "'; DROP TABLE attempts; --", "名前", "🤖 7"):
        assert course_of().post(RIGHT, learner).json()["attempt"]["learner"] == learner


@pytest.mark.long
def test_no_learner_has_a_character_that_is_not_seen() -> None:
    taken = TypeAdapter(Learner)
    for character in map(chr, range(0x110000)):
        # As the Unicode tables of Python say, which do not know unassigned characters.
        if unicodedata.category(character) in ("Cc", "Cf", "Co", "Zl", "Zp", "Zs"):
            with pytest.raises(ValidationError):
                taken.validate_python(f"a{character}")


@pytest.mark.long
def test_a_page_of_another_origin_cannot_record(
    catalogue: Mapping[str, Exercise], store: AttemptStore, client_of: Any
) -> None:
    # A browser sends a body of the type text/plain without asking the service first.
    course = "https://course.example.edu"

    def status(origin: str | None, *allowed: str) -> tuple[int, int]:
        client = client_of(application(catalogue, allowed, store=store))
        headers = {"Content-Type": "text/plain"} | ({"Origin": origin} if origin else {})
        content = json.dumps({"answers": RIGHT, "learner": "ada"})
        before = count(store)
        answer = client.post("/v1/exercises/scara/attempts", content=content, headers=headers)
        return answer.status_code, count(store) - before

    assert status(None) == status("http://service") == (201, 1)
    assert status("https://evil.example") == status("null") == (403, 0)
    assert status("https://evil.example", course) == (403, 0)
    assert status(course, course) == status("https://any.example", "*") == (201, 1)


@pytest.mark.long
def test_the_page_on_attempts_shows_the_real_answer(course_of: Any) -> None:
    page = (Path(__file__).parents[3] / "docs" / "attempts.md").read_text(encoding="utf-8")
    sent, shown, *_ = re.findall(r"```json(?: attempt\.json)?\n(.*?)```", page, re.DOTALL)
    [(url, headers)] = re.findall(
        r"^curl -s http://127\.0\.0\.1:8000(\S+) \\\n(.*) -d @attempt\.json$", page, re.MULTILINE
    )
    answered = course_of()._client.post(
        url,
        content=sent.encode(),
        headers=dict(each.split(": ") for each in re.findall(r"-H '(.*?)'", headers)),
    )
    assert answered.status_code == 201
    recorded, expected = answered.json(), json.loads(shown)
    attempt = recorded["attempt"]
    its_own = {"id": attempt["id"], "at": attempt["at"]}
    assert attempt == expected["attempt"] | its_own
    assert [len(each) for each in its_own.values()] == [
        len(expected["attempt"][key]) for key in its_own
    ]
    assert recorded.keys() == expected.keys()
    assert expected["report"].items() <= recorded["report"].items()
