"""Test how attempts are recorded, listed and managed."""

import asyncio
import csv
import io
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
from dh_grader import store as graded
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise, FeedbackLevel, load_catalogue, shipped_folder
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import Learner
from dh_grader.formats.graded import with_texts
from dh_grader.grading import GradedAnswers, Report, Submission, graded_answers
from dh_grader.store import AttemptFilter, GradesFormat, StoreDownError, recorded_report
from dh_grader.store import regrades as regrade_steps
from dh_grader.store import regrades as regrading
from dh_grader.store import results as grades
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.results import everything_of
from dh_grader.store.tables import attempts
from fastapi import FastAPI
from jsonschema import Draft202012Validator
from pydantic import TypeAdapter, ValidationError
from sqlalchemy import select, text

from tests.api.conftest import InProcess
from tests.attack.honest import watched
from tests.attack.interface import with_key
from tests.server.raw import HEALTH, service
from tests.store import campaign
from tests.store.recorded import LAZY, NO_TWIST, RIGHT, files_with, reader, recorded
from tests.translations.german import as_sentence, messages_in, offer_german

NEW_ATTEMPTS_RIGHT = {"table": "a1 0 0 θ1\na2 180deg 0 θ2\n0 0 d3 0\n0 0 d4 θ4"}
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
    assert problem(course.post(NEW_ATTEMPTS_RIGHT, key="k")) == (422, "idempotency-key-reused")
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
    recorded = course_of(**rules, late_worth=0.5).post(NEW_ATTEMPTS_RIGHT).json()
    assert recorded["attempt"]["is_late"]
    assert recorded["attempt"]["points"] == recorded["report"]["points"] / 2
    assert problem(course_of(due=now - timedelta(hours=1)).post(NEW_ATTEMPTS_RIGHT)) == (
        403,
        "closed",
    )
    assert problem(course_of(opens=now + timedelta(hours=1)).post(NEW_ATTEMPTS_RIGHT)) == (
        403,
        "not-open",
    )


def test_without_a_database_nothing_is_recorded(client: httpx.Client) -> None:
    body = {"answers": NEW_ATTEMPTS_RIGHT, "learner": "ada"}
    response = client.post("/v1/exercises/scara/attempts", json=body)
    assert problem(response) == (404, "attempts-not-recorded")


def test_while_the_database_is_down_grading_goes_on(course_of: Any, store: AttemptStore) -> None:
    course = course_of()
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE attempts RENAME TO hidden"))
    refused = course.post(NEW_ATTEMPTS_RIGHT)
    assert problem(refused) == (503, "store-down")
    assert int(refused.headers["Retry-After"]) > 0
    graded = course._client.post("/v1/exercises/scara/grade", json={"answers": NEW_ATTEMPTS_RIGHT})
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
    assert problem(course_of().post(NEW_ATTEMPTS_RIGHT, learner)) == (422, "invalid-request")


@pytest.mark.long
def test_a_learner_may_have_any_letters(course_of: Any) -> None:
    for learner in ("Ада Лавлейс", "ada@example.edu", "'; DROP TABLE attempts; --", "名前", "🤖 7"):
        assert course_of().post(NEW_ATTEMPTS_RIGHT, learner).json()["attempt"]["learner"] == learner


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
        content = json.dumps({"answers": NEW_ATTEMPTS_RIGHT, "learner": "ada"})
        before = count(store)
        answer = client.post("/v1/exercises/scara/attempts", content=content, headers=headers)
        return answer.status_code, count(store) - before

    assert status(None) == status("http://service") == (201, 1)
    assert status("https://evil.example") == status("null") == (403, 0)
    assert status("https://evil.example", course) == (403, 0)
    assert status(course, course) == status("https://any.example", "*") == (201, 1)


@pytest.mark.long
def test_the_page_on_attempts_shows_the_real_answer(course_of: Any) -> None:
    page = (Path(__file__).parents[2] / "docs" / "attempts.md").read_text(encoding="utf-8")
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


# --- Listing

PATHS = ("/v1/attempts", "/v1/attempts/" + 32 * "0", "/v1/exercises/scara/statistics")


Tutor = Any


@pytest.fixture
def tutor_of(catalogue: Mapping[str, Exercise], store: AttemptStore) -> Tutor:
    def make(
        read_attempts: bool | None = None, at: str = "http://127.0.0.1:8000", **headers: str
    ) -> httpx.Client:
        app = application(catalogue, store=store, access=Access(read_attempts=read_attempts))
        return httpx.Client(transport=InProcess(app), base_url=at, headers=headers)

    return make


def post(client: httpx.Client, learner: str) -> Any:
    body = {"learner": learner, "answers": WRONG, "angle_unit": "degrees"}
    return client.post("/v1/exercises/scara/attempts", json=body).json()


def test_recorded_attempts_can_be_read(tutor_of: Tutor) -> None:
    tutor = tutor_of()
    posted = [post(tutor, learner) for learner in ("ada", "grace", "ada")]
    first = tutor.get("/v1/attempts", params={"limit": 2}).json()
    rest = tutor.get("/v1/attempts", params={"limit": 2, "cursor": first["next"]}).json()
    listed = [*first["attempts"], *rest["attempts"]]
    assert "next" not in rest
    assert [each["id"] for each in listed] == [each["attempt"]["id"] for each in posted[::-1]]
    of_grace = tutor.get("/v1/attempts", params={"learner": "grace", "exercise": "scara"}).json()
    assert [each["learner"] for each in of_grace["attempts"]] == ["grace"]
    shown = tutor.get(f"/v1/attempts/{posted[0]['attempt']['id']}")
    assert shown.headers["Cache-Control"] == "no-store"
    assert shown.json()["submission"] == {"answers": WRONG, "angle_unit": "degrees"}
    assert shown.json()["report"] == posted[0]["report"]
    figures = tutor.get("/v1/exercises/scara/statistics").json()
    assert (figures["attempts"], figures["learners"]) == (3, 2)
    assert figures["identical"][0]["among"] == ["ada", "grace"]


@pytest.mark.long
def test_each_reader_gets_a_recorded_report_in_the_own_language(
    tutor_of: Tutor, store: AttemptStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    offer_german(monkeypatch, {"no answer": "keine Antwort"})

    def recorded(report: Report) -> str:
        return recorded_report(with_texts(report, as_sentence))

    monkeypatch.setattr(graded, "recorded_report", recorded)
    client: httpx.Client = tutor_of()

    def post(query: str) -> httpx.Response:
        body = {"learner": "ada", "answers": WRONG}
        headers = {"Idempotency-Key": "1"}
        return client.post(f"/v1/exercises/scara/attempts{query}", json=body, headers=headers)

    german, english = post("?lang=de"), post("")
    assert (german.status_code, german.headers["content-language"]) == (201, "de")
    assert "keine Antwort" in messages_in(german.json()["report"])
    # The same attempt, sent again by a reader of English.
    assert english.json()["attempt"] == german.json()["attempt"]
    assert "no answer" in messages_in(english.json()["report"])
    path = f"/v1/attempts/{german.json()['attempt']['id']}"
    shown = client.get(path, headers={"Accept-Language": "de"})
    assert (shown.headers["content-language"], shown.json()["report"]) == (
        "de",
        german.json()["report"],
    )
    assert client.get(path).json()["report"] == english.json()["report"]
    with store.engine.connect() as connection:
        assert '{"sentences":' in (connection.scalar(select(attempts.c.report)) or "")
        exported = everything_of(connection, "ada")
    assert exported["attempts"][0]["report"] == english.json()["report"]
    assert "sentences" not in client.get("/v1/attempts/export?format=jsonl").text


@pytest.mark.long
def test_every_field_of_an_attempt_is_documented(tutor_of: Tutor) -> None:
    tutor = tutor_of()
    attempt = post(tutor, "ada")["attempt"]["id"]
    document = tutor.get("/openapi.json").json()
    for path, schema in (
        ("/v1/attempts", "AttemptList"),
        (f"/v1/attempts/{attempt}", "AttemptDetail"),
        ("/v1/exercises/scara/statistics", "ExerciseStatistics"),
    ):
        named = document["components"]["schemas"]
        for each in named.values():
            if "properties" in each:
                each["additionalProperties"] = False
        Draft202012Validator({**named[schema], "components": {"schemas": named}}).validate(
            tutor.get(path).json()
        )


@pytest.mark.long
@pytest.mark.parametrize("path", PATHS)
def test_only_callers_with_the_right_read(tutor_of: Tutor, path: str) -> None:
    def status(*options: Any, **headers: str) -> int:
        return int(tutor_of(*options, **headers).get(path).status_code)

    readable = 404 if "000" in path else 200
    elsewhere = "http://grader.example.edu"
    assert status() == readable
    assert status(Host="localhost:8000") == readable
    # A proxy on the machine, a page of another origin, a name that resolves to the machine.
    assert status(**{"X-Forwarded-For": "10.0.0.7"}) == 403
    assert status(Origin="https://evil.example") == 403
    assert status(Host="grader.example.edu") == status(None, elsewhere) == 403
    assert status(True, elsewhere) == readable
    assert status(True, elsewhere, Origin="https://evil.example") == 403
    assert status(False) == 403


def test_a_plain_application_shows_nothing(client: httpx.Client) -> None:
    assert {client.get(path).status_code for path in PATHS} == {403}


@pytest.mark.sampled(12)
@pytest.mark.parametrize(
    ("query", "status"),
    [
        ("limit=0", 422),
        ("limit=101", 422),
        ("limit=100", 200),
        ("cursor=x", 422),
        ("since=2026-10-01", 422),
        ("since=0.5", 422),
        ("until=1790000000", 422),
        ("since=0001-01-01T00:00:00%2B14:00", 422),
        ("since=9999-12-31T23:59:59Z", 200),
        ("learner=%00", 422),
        ("exercise=%00", 422),
        ("exercise=no-such", 200),
        ("counted=maybe", 422),
    ],
)
def test_a_query_is_checked(tutor_of: Tutor, query: str, status: int) -> None:
    assert tutor_of().get(f"/v1/attempts?{query}").status_code == status


@pytest.mark.long
def test_unknown_attempts_and_exercises_are_not_found(tutor_of: Tutor, catalogue: Any) -> None:
    assert tutor_of().get("/v1/attempts/%00").status_code == 404
    assert tutor_of().get("/v1/exercises/no-such/statistics").status_code == 404
    nothing = application(catalogue, access=Access(read_attempts=True))
    with httpx.Client(transport=InProcess(nothing), base_url="http://a") as client:
        assert client.get("/v1/attempts").json()["type"].endswith("attempts-not-recorded")


@pytest.mark.long
def test_reading_gets_503_while_the_database_is_down(tutor_of: Tutor, store: AttemptStore) -> None:
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE attempts RENAME TO hidden"))
    assert {tutor_of().get(path).status_code for path in PATHS} == {503}


# --- Test the routes with which tutors export, change and delete attempts

HERE = "http://127.0.0.1:8000"
NOBODY = 32 * "0"
# The body of each route that has one.
BODIES: Mapping[str, Any] = {
    "/v1/attempts/export": None,
    f"/v1/attempts/{NOBODY}/override": {"reason": "x"},
    "/v1/learners/forget": {"learner": "nobody"},
    "/v1/exercises/scara/regrade": {},
}


class ManagingTutor:
    """Sends requests as a tutor to a service that runs in this process."""

    def __init__(
        self, exercises: Mapping[str, Exercise], store: AttemptStore | None,
        reads: bool | None = None,
    ) -> None:  # fmt: skip
        self.app = application(exercises, store=store, access=Access(read_attempts=reads))

    def ask(
        self, method: str, path: str, body: Any = None, at: str = HERE, **headers: str
    ) -> httpx.Response:
        with httpx.Client(transport=InProcess(self.app), base_url=at, headers=headers) as client:
            return client.request(method, path, json=body)

    def asked(self, path: str, **more: str) -> httpx.Response:
        body = BODIES[path]
        return self.ask("GET" if body is None else "POST", path, body, **more)

    def post(self, path: str, **body: Any) -> Any:
        answer = self.ask("POST", path, body)
        assert answer.status_code == 200, answer.text
        return answer.json()


@pytest.fixture
def tutor(catalogue: Mapping[str, Exercise], store: AttemptStore) -> ManagingTutor:
    return ManagingTutor(catalogue, store)


def corrected(folder: Path) -> Mapping[str, Exercise]:
    text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
    assert text.count('["a2", "180deg",') == 1, "the exercise has changed"
    folder.mkdir()
    changed = text.replace('["a2", "180deg",', '["a2", "0",')
    (folder / "scara.toml").write_text(changed.partition("[[checks]]")[0], encoding="utf-8")
    return load_catalogue(folder)


def test_an_export_gives_way_after_each_page(
    store: AttemptStore, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(grades, "_PAGE", 2)
    for learner in "abcde":
        recorded(store, catalogue["scara"], learner, RIGHT)
    turns = 0

    async def give_way() -> None:
        nonlocal turns
        turns += 1
        await asyncio.sleep(0)

    for form in GradesFormat:
        turns = 0
        asyncio.run(
            store.export(AttemptFilter("scara"), form, "x", lambda _: "best", give_way)
        ).close()
        assert turns == 3


def test_an_export_that_waits_for_its_turn_ends_with_the_store(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    recorded(store, catalogue["scara"], "ada", RIGHT)

    async def story() -> None:
        waits = asyncio.Event()

        async def give_way() -> None:
            waits.set()
            await asyncio.Event().wait()

        export = store.export(
            AttemptFilter("scara"), GradesFormat.CSV, "x", lambda _: "best", give_way
        )
        running = asyncio.ensure_future(export)
        await waits.wait()
        await asyncio.to_thread(store.close)
        with pytest.raises(StoreDownError):
            await running

    asyncio.run(story())


def test_attempts_are_exported(
    tutor: ManagingTutor, store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    first = recorded(store, scara, "=ada", NO_TWIST)
    best = recorded(store, scara, "=ada", RIGHT, 2, hours=1)
    answer = tutor.ask("GET", "/v1/attempts/export?exercise=scara")
    assert answer.headers["Content-Type"].startswith("text/csv")
    assert answer.headers["Cache-Control"] == "no-store"
    named = answer.headers["Content-Disposition"]
    assert named == 'attachment; filename="attempts-scara.csv"'
    lines = list(csv.DictReader(io.StringIO(answer.text)))
    assert [(each["attempt"], each["counts"]) for each in lines] == [
        (first.id, "false"), (best.id, "true")
    ]  # fmt: skip
    # No spreadsheet reads a name as a formula.
    assert {each["learner"] for each in lines} == {"'=ada"}
    exported = tutor.ask("GET", "/v1/attempts/export?format=jsonl&until=2026-11-22T12:30:00Z")
    assert [json.loads(line)["attempt"] for line in exported.text.splitlines()] == [first.id]
    for form, headings in (("canvas", "SIS Login ID"), ("moodle", "Identifier")):
        book = tutor.ask("GET", f"/v1/attempts/export?exercise=scara&format={form}")
        assert headings in book.text.splitlines()[0]
        assert f'filename="{form}-scara.csv"' in book.headers["Content-Disposition"]
        assert tutor.ask("GET", f"/v1/attempts/export?format={form}").status_code == 422
    strange = tutor.ask("GET", '/v1/attempts/export?exercise=a";b=ü/../c')
    assert 'filename="attempts.csv"' in strange.headers["Content-Disposition"]


def test_an_attempt_gets_other_points_with_a_reason(
    tutor: ManagingTutor, store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    attempt = recorded(store, catalogue["scara"], "ada", NO_TWIST)
    path = f"/v1/attempts/{attempt.id}"
    given = tutor.post(f"{path}/override", points=20, reason="A misprint.", author="Dr. Lee")
    assert (given["awarded"], given["points"]) == (20, attempt.points)
    withdrawn = tutor.post(f"{path}/override", reason="It was none.")
    assert "awarded" not in withdrawn
    kept = tutor.ask("GET", path).json()["overrides"]
    assert [(each.get("points"), each["reason"], each["author"]) for each in kept] == [
        (20, "A misprint.", "Dr. Lee (at the machine)"), (None, "It was none.", "at the machine")
    ]  # fmt: skip
    refused: list[dict[str, Any]] = [
        {"points": 24.5, "reason": "x"}, {"points": -1, "reason": "x"}, {"points": 1},
        {"points": 1, "reason": "  "}, {"points": 1, "reason": "a\nb"},
        {"points": "3", "reason": "x"}, {"points": True, "reason": "x"},
    ]  # fmt: skip
    answers = [tutor.ask("POST", f"{path}/override", body) for body in refused]
    assert [each.status_code for each in answers] == [422] * len(refused)
    assert "0 to 24 points" in answers[0].json()["detail"]
    unknown = tutor.ask("POST", f"/v1/attempts/{32 * '0'}/override", {"points": 1, "reason": "x"})
    assert unknown.json()["type"].endswith("unknown-attempt")


def test_a_learner_is_deleted_only_with_apply(
    tutor: ManagingTutor, store: AttemptStore, catalogue: Mapping[str, Exercise], tmp_path: Path
) -> None:
    for learner in ("ada-4711", "grace"):
        recorded(store, catalogue["scara"], learner, NO_TWIST)
    counts = {"attempts": 1, "earlier_reports": 0, "overrides": 0, "courses": 0}
    told = tutor.post("/v1/learners/forget", learner="ada-4711")
    assert told == {"learner": "ada-4711", "deleted": False, **counts}
    assert len(tutor.ask("GET", "/v1/attempts").json()["attempts"]) == 2
    told = tutor.post("/v1/learners/forget", learner="ada-4711", apply=True)
    assert told == {"learner": "ada-4711", "deleted": True, "erased": True, **counts}
    left = tutor.ask("GET", "/v1/attempts").json()["attempts"]
    assert [each["learner"] for each in left] == ["grace"]
    assert tutor.post("/v1/learners/forget", learner="ada-4711", apply=True)["attempts"] == 0
    files = list(tmp_path.glob("attempts.db*"))
    assert not any(b"ada-4711" in file.read_bytes() for file in files)


@pytest.mark.long
def test_a_tutor_reads_that_a_text_is_still_in_a_file(
    tutor: ManagingTutor, store: AttemptStore, catalogue: Mapping[str, Exercise], tmp_path: Path
) -> None:
    path = str(tmp_path / "attempts.db")
    recorded(store, catalogue["scara"], "ada-4711", NO_TWIST)
    with reader(path):
        told = tutor.post("/v1/learners/forget", learner="ada-4711", apply=True)
        assert (told["deleted"], told["erased"], told["attempts"]) == (True, False, 1)
        assert files_with("ada-4711", path)
    told = tutor.post("/v1/learners/forget", learner="ada-4711", apply=True)
    assert (told["deleted"], told["erased"], told["attempts"]) == (True, True, 0)
    assert files_with("ada-4711", path) == []


@pytest.mark.long
def test_a_regrade_goes_step_by_step(
    store: AttemptStore, catalogue: Mapping[str, Exercise], tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    scara = catalogue["scara"]
    for number in range(7):
        recorded(store, scara, f"wrong-{number}", NO_TWIST, hours=-number)
        recorded(store, scara, f"lazy-{number}", LAZY)
    path = "/v1/exercises/scara/regrade"
    [given] = (
        ManagingTutor(catalogue, store)
        .ask("GET", "/v1/attempts?learner=wrong-1")
        .json()["attempts"]
    )
    ManagingTutor(catalogue, store).post(
        f"/v1/attempts/{given['id']}/override", points=7.5, reason="r"
    )
    # With the same version and program nothing is outdated.
    same = ManagingTutor(catalogue, store)
    assert same.post(path) == {"applied": False, "regraded": 0, "left": 0, "changes": []}
    # Few attempts in each step, as if they were slow.
    monkeypatch.setattr(regrade_steps, "_MOST", 4)
    monkeypatch.setattr(regrade_steps, "_PREVIEW_BATCH", 4)
    monkeypatch.setattr(regrading, "BATCH", 4)
    tutor = ManagingTutor(corrected(tmp_path / "corrected"), store)

    def all_steps(apply: bool) -> list[Any]:
        steps = [tutor.post(path, apply=apply)]
        while "next" in steps[-1]:
            steps.append(tutor.post(path, apply=apply, cursor=steps[-1]["next"]))
        return steps

    dry = all_steps(apply=False)
    assert [(each["regraded"], each["left"]) for each in dry] == [(4, 10), (4, 6), (4, 2), (2, 0)]
    changes = {each["learner"]: each for step in dry for each in step["changes"]}
    assert {name for name in changes if name[:5] == "wrong"} == {f"wrong-{i}" for i in range(7)}
    assert (changes["wrong-0"]["after"], changes["wrong-0"]["max_points"]) == (8, 24)
    assert changes["wrong-0"]["reasons"][0].startswith("table ")
    assert [changes[f"wrong-{i}"].get("awarded") for i in range(2)] == [None, 7.5]
    [before] = tutor.ask("GET", "/v1/attempts?learner=wrong-0").json()["attempts"]
    assert before["points"] == changes["wrong-0"]["before"]

    done = all_steps(apply=True)
    assert sum(each["regraded"] for each in done) == 14
    assert {each["id"] for step in done for each in step["changes"]} == {
        each["id"] for each in changes.values()
    }
    after = tutor.ask("GET", f"/v1/attempts/{before['id']}").json()
    assert (after["attempt"]["points"], len(after["earlier_reports"])) == (8, 1)
    assert all_steps(apply=False)[0]["regraded"] == 0
    for cursor in ("x", "1.2", ":", "1.2:g", "f" * 20 + ".1:1"):
        assert tutor.ask("POST", path, {"cursor": cursor}).status_code == 422


@pytest.mark.long
def test_an_exercise_that_fails_its_check_regrades_only_if_forced(
    store: AttemptStore, catalogue: Mapping[str, Exercise], tmp_path: Path
) -> None:
    recorded(store, catalogue["scara"], "ada", NO_TWIST)
    text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
    # Its checks still say what was right before.
    wrong = text.replace('["a2", "180deg",', '["a2", "0",')
    (tmp_path / "scara.toml").write_text(wrong, encoding="utf-8")
    tutor = ManagingTutor(load_catalogue(tmp_path), store)
    path = "/v1/exercises/scara/regrade"
    preview = tutor.post(path)
    assert preview["regraded"] == 1
    assert preview["failures"]
    refused = tutor.ask("POST", path, {"apply": True})
    assert refused.status_code == 409
    assert refused.json()["type"].endswith(":exercise-fails")
    assert preview["failures"][0] in refused.json()["detail"]
    german = tutor.ask("POST", path, {}, **{"accept-language": "de"}).json()["failures"]
    assert "table sollte die volle Punktzahl bekommen" in german[0]
    done = tutor.post(path, apply=True, force=True)
    assert (done["applied"], done["regraded"]) == (True, 1)


@pytest.mark.long
def test_only_callers_with_the_right_change_attempts(
    tutor: ManagingTutor, store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    def statuses(tutor: ManagingTutor, **more: str) -> list[int]:
        return [tutor.asked(path, **more).status_code for path in BODIES]

    assert statuses(tutor) == [200, 404, 200, 200]
    none = [403] * len(BODIES)
    assert statuses(tutor, **{"X-Forwarded-For": "10.0.0.7"}) == none
    # A page of another origin can make a tutor's browser send requests.
    assert statuses(tutor, Origin="https://evil.example") == none
    assert statuses(tutor, Origin="null") == none
    elsewhere = "http://grader.example.edu"
    assert statuses(tutor, at=elsewhere) == none
    assert statuses(ManagingTutor(catalogue, store, reads=False)) == none
    # If everybody may read, still only tutors may change.
    opened = ManagingTutor(catalogue, store, reads=True)
    assert statuses(opened, at=elsewhere) == [200, 403, 403, 403]
    assert statuses(opened) == [200, 404, 200, 200]


@pytest.mark.long
def test_impossible_changes_are_refused(
    tutor: ManagingTutor, store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    without = ManagingTutor(catalogue, None)
    for path in BODIES:
        assert without.asked(path).json()["type"].endswith("attempts-not-recorded")
    assert tutor.ask("POST", "/v1/exercises/no-such/regrade", {}).status_code == 404
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE attempts RENAME TO hidden"))
    for path in BODIES:
        answer = tutor.asked(path)
        assert (answer.status_code, answer.headers["Retry-After"]) == (503, "5")


@pytest.mark.long
def test_others_are_answered_while_a_regrade_goes_on(
    catalogue: Mapping[str, Exercise], store: AttemptStore, tmp_path: Path
) -> None:
    for number in range(20):
        recorded(store, catalogue["scara"], f"u{number}", NO_TWIST)
    app = ManagingTutor(corrected(tmp_path / "corrected"), store).app

    async def both() -> tuple[int, bool, int]:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url=HERE) as client:
            regrade = asyncio.create_task(client.post("/v1/exercises/scara/regrade", json={}))
            await asyncio.sleep(0)
            answered = (await client.get("/v1/exercises")).status_code
            return answered, regrade.done(), (await regrade).json()["regraded"]

    assert asyncio.run(both()) == (200, False, 20)


@pytest.mark.long
def test_a_tutor_who_leaves_during_an_export_leaves_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The log is read when the service ends. Beside other clients, an export waits for its turns.
    settings, key = with_key(tmp_path)
    store = AttemptStore.open(settings["DH_GRADER_DATABASE"])
    monkeypatch.setattr(campaign, "TABLES", 20)
    campaign.fill(store, load_catalogue(shipped_folder())["scara"], 50_000)
    store.close()
    ask = f"GET /v1/attempts/export HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer {key}\r\n\r\n"
    with (
        service(tmp_path, **settings, DH_GRADER_OPEN="grade,record") as running,
        watched(running) as (submissions, _),
    ):
        with running.connect(ask.encode()) as line:
            assert b"200 OK" in line.recv(4096)
        running.ask(HEALTH)
    assert submissions.seconds
    assert not submissions.failures
