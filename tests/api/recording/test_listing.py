from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.formats.graded import with_texts
from dh_grader.grading import Report
from dh_grader.store import AttemptStore
from dh_grader.store import attempts as graded
from dh_grader.store.attempts import recorded_report
from dh_grader.store.results import everything_of
from dh_grader.store.tables import attempts
from jsonschema import Draft202012Validator
from sqlalchemy import select, text

from tests.api.conftest import InProcess
from tests.translations.german import as_sentence, messages_in, offer_german

WRONG = {"table": "a1 0 0 θ1\na2 0 0 θ2\n0 0 d3 0\n0 0 d4 θ4"}
PATHS = ("/v1/attempts", "/v1/attempts/" + 32 * "0", "/v1/exercises/scara/statistics")


@pytest.fixture
def store(tmp_path: Path) -> Iterator[AttemptStore]:
    store = AttemptStore.open(str(tmp_path / "attempts.db"))
    store.start()
    yield store
    store.close()


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
