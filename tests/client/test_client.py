"""Test the client."""

import json
import socket
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from email.utils import format_datetime
from random import Random
from typing import Any
from uuid import UUID

import pytest
from dh_grader import client as received
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.client import (
    ExerciseSubmission,
    GraderClient,
    GraderClientError,
    RequestRefusedError,
    Retries,
    ServerUnreachableError,
    UnexpectedAnswerError,
    checked_server,
    client_options,
    grade_many,
)
from dh_grader.client import grade as calls_grade
from dh_grader.grading import Submission, Verdict, grade
from dh_grader.submissions.bodies import MAX_BODY_SIZE, MAX_SUBMISSIONS, read_json

from tests.api.serving import Served
from tests.attack.bodies import model_of, spoiled
from tests.client.conftest import Using
from tests.client.scripted import http, scripted

# --- Test the sync and the async client, with real and with failing servers

READY = http(200, json.dumps({"exercises": []}))
BUSY = {"type": "about:blank", "title": "Busy", "status": 503, "detail": "Wait.", "instance": "/"}


def in_a_file(value: object) -> Any:
    return read_json(json.dumps(value).encode())


def posts(server: Served) -> int:
    return server.log.read_text(encoding="utf-8").count('"POST /v1/')


def test_the_client_lists_the_exercises_of_the_catalogue(
    server: Served, using: Using, catalogue: Mapping[str, Exercise]
) -> None:
    listed = using(server.address, lambda client: client.exercises())
    assert [(each.id, each.title) for each in listed] == [
        (each.id, each.title) for each in catalogue.values()
    ]


def test_an_exercise_has_the_shapes_of_its_answers(server: Served, using: Using) -> None:
    exercise = using(server.address, lambda client: client.exercise("stanford-arm"))
    assert exercise.feedback is FeedbackLevel.HINTS
    assert [(part.id, part.shape.form) for part in exercise.parts] == [
        ("table", "dh_table"), ("links", "link_transforms"), ("pose", "matrix"),
    ]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("every", [3, pytest.param(1, marks=pytest.mark.campaign)])
def test_a_report_over_http_equals_a_local_report(
    server: Served, catalogue: Mapping[str, Exercise], every: int
) -> None:
    random = Random(13)
    exercises = [*catalogue.values()][::every]
    right = [(exercise, model_of(exercise).answers) for exercise in exercises]
    # JSON has no infinity and no lone surrogates.
    wrong = [(exercise, in_a_file(spoiled(answers, random, 0.2))) for exercise, answers in right]
    with GraderClient(server.address) as client:
        for exercise, answers in right + wrong:
            here = grade(exercise, Submission(answers, feedback=exercise.feedback))
            assert client.grade(exercise.id, answers) == here
            # A row that is given is not read.
            given = any(getattr(part, "given", ()) for part in exercise.parts)
            if (exercise, answers) in right or not given:
                assert (here.score == 1) is ((exercise, answers) in right)


def test_the_options_of_a_grading_are_used(server: Served, using: Using) -> None:
    rows = [{"a": "0", "alpha": "0", "d": "0", "theta": "q1 + 90"}]
    report = using(
        server.address,
        lambda client: client.grade(
            "planar-rr",
            {"table": {"rows": rows}},
            angle_unit="degrees",
            feedback=FeedbackLevel.VERDICTS,
            echo=True,
        ),
    )
    assert report.feedback is FeedbackLevel.VERDICTS
    *_, theta = report.parts[0].rows[0].cells
    assert theta.read is not None
    assert theta.read.text == "theta1 + 90deg"


@pytest.mark.sampled(2)
def test_many_submissions_are_graded_in_order_and_in_few_requests(
    server: Served, using: Using
) -> None:
    ids = ["planar-rr", "no-such-exercise", *["planar-rr"] * (MAX_SUBMISSIONS + 6)]
    submissions = [ExerciseSubmission(exercise=each, answers={}) for each in ids]
    before = posts(server)
    results = using(server.address, lambda client: client.grade_many(submissions))
    assert posts(server) == before + 2
    assert [result.report is None for result in results] == [each != "planar-rr" for each in ids]
    assert results[1].problem.type.endswith(":unknown-exercise")
    assert {part.verdict for part in results[0].report.parts} == {Verdict.MISSING}


def test_a_hint_explains_a_message_in_steps(server: Served, using: Using) -> None:
    answers = {"position": ["-a1 c1 - a2 c12", "-a1 s1 - a2 s12"]}
    report = using(server.address, lambda client: client.grade("planar-rr", answers))
    [part] = [each for each in report.parts if each.part == "position"]
    [message] = part.feedback
    given = ("planar-rr", answers, "position", message.code)
    assert message.places is not None
    at = {"row": message.places[0].row, "cell": message.places[0].cell}
    first, second, third = [
        using(server.address, lambda client, step=step: client.hint(*given, step, **at))
        for step in (1, 2, 3)
    ]
    assert (first.step, second.step, third.step) == (1, 2, 3)
    assert second.title == "The position"
    assert len({first.text, second.text, third.text}) == 3


def test_preview_returns_the_reading_of_a_text(server: Served, using: Using) -> None:
    read = using(
        server.address,
        lambda client: client.preview("l1 c1 +", exercise="planar-rrr", quantity="length"),
    )
    assert (read.ok, read.error.code, read.error.suggestion) == (
        False, "trailing_operator", "l1 c1",
    )  # fmt: skip


def test_a_refusal_names_its_reason_and_is_not_retried(server: Served, using: Using) -> None:
    before = posts(server)
    with pytest.raises(RequestRefusedError, match="Did you mean 'planar-rr'") as caught:
        using(server.address, lambda client: client.grade("planar-r", {}))
    refused = caught.value
    assert (refused.status, refused.code) == (404, "unknown-exercise")
    with pytest.raises(RequestRefusedError) as caught:
        using(server.address, lambda client: client.grade("planar-rr", {"tabel": 1}))
    refused = caught.value
    assert (refused.status, refused.code) == (422, "unknown-part")
    assert [reason.pointer for reason in refused.reasons] == ["#/answers/tabel"]
    assert posts(server) == before + 2


def test_retries_have_the_same_idempotency_key(using: Using) -> None:
    report = b""  # the connection closes without an answer
    busy = http(503, json.dumps(BUSY), retry_after="0")
    done = http(200, json.dumps({"ok": True}))
    with scripted(report, busy, done) as server:
        read = using(server.address, lambda client: client.preview("c1"), key="dhg_a.b-c==")
    assert read.ok
    assert [each.line for each in server.requests] == ["POST /v1/preview HTTP/1.1"] * 3
    assert {each.headers["authorization"] for each in server.requests} == {"Bearer dhg_a.b-c=="}
    (key,) = {each.headers["idempotency-key"] for each in server.requests}
    assert UUID(key).version == 4
    assert {each.body for each in server.requests} == {b'{"text":"c1"}'}


def test_the_idempotency_key_of_the_caller_is_sent(using: Using) -> None:
    with scripted(http(404)) as server, pytest.raises(RequestRefusedError):
        using(server.address, lambda client: client.grade("x", {}, idempotency_key="mine"))
    assert server.requests[0].headers["idempotency-key"] == "mine"


@pytest.mark.sampled(4)
@pytest.mark.parametrize("status", [400, 401, 403, 404, 408, 409, 413, 422, 500])
def test_other_statuses_are_not_retried(using: Using, status: int) -> None:
    with scripted(http(status, "<h1>no</h1>"), READY) as server:
        with pytest.raises(RequestRefusedError, match=f"the status {status}") as caught:
            using(server.address, lambda client: client.exercises())
        assert len(server.requests) == 1
    assert (caught.value.status, caught.value.is_temporary) == (status, False)


@pytest.mark.parametrize("status", [429, 502, 503, 504])
def test_temporary_statuses_are_retried_until_the_limit(using: Using, status: int) -> None:
    with scripted(*[http(status, "<h1>no</h1>")] * 3, READY) as server:
        with pytest.raises(RequestRefusedError) as caught:
            using(server.address, lambda client: client.exercises())
        assert len(server.requests) == 3
    assert (caught.value.status, caught.value.is_temporary) == (status, True)


@pytest.mark.parametrize("date", ["6", format_datetime(datetime(2200, 1, 1, tzinfo=UTC))])
def test_a_call_is_not_retried_after_a_request_for_a_long_wait(using: Using, date: str) -> None:
    with scripted(http(503, json.dumps(BUSY), retry_after=date), READY) as server:
        with pytest.raises(RequestRefusedError, match=r"Wait\."):
            using(server.address, lambda client: client.exercises())
        assert len(server.requests) == 1


@pytest.mark.parametrize("date", ["0", "Sun, 06 Nov 1994 08:49:37 GMT", "soon", "-1", "²"])
def test_a_past_or_invalid_retry_after_means_no_wait(using: Using, date: str) -> None:
    with scripted(http(429, retry_after=date), READY) as server:
        assert using(server.address, lambda client: client.exercises()) == []


def test_the_client_does_not_follow_redirections(using: Using) -> None:
    with scripted(READY) as other, scripted(http(307, location=f"{other.address}/v1")) as server:
        with pytest.raises(UnexpectedAnswerError, match=f"redirects to {other.address}/v1"):
            using(server.address, lambda client: client.exercises(), key="secret")
        assert other.requests == []


@pytest.mark.parametrize("prefix", ["/grader", "/a/b/"])
def test_a_service_may_be_below_a_path(using: Using, prefix: str) -> None:
    with scripted(READY, http(404)) as server:
        using(server.address + prefix, lambda client: client.exercises())
        with pytest.raises(RequestRefusedError):
            using(server.address + prefix, lambda client: client.exercise("../../x?y#z/é"))
    place = prefix.rstrip("/")
    assert [each.line.split()[1] for each in server.requests] == [
        f"{place}/v1/exercises",
        f"{place}/v1/exercises/%2E%2E%2F%2E%2E%2Fx%3Fy%23z%2F%C3%A9",
    ]


@pytest.mark.parametrize(
    "body", ["", "<h1>Welcome</h1>", "[]", '{"exercises": [{"id": 1}]}', b"\xff", "[" * 100_000]
)
def test_an_unexpected_answer_is_reported(using: Using, body: str | bytes) -> None:
    expected = pytest.raises(UnexpectedAnswerError, match="is not that of a DH Grader")
    with scripted(http(200, body)) as server, expected:
        using(server.address, lambda client: client.exercises())


def test_an_endless_answer_is_cut_off(using: Using, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(received, "MAX_ANSWER", 1024 * 1024)
    sent: list[int] = []

    def endless() -> Iterator[bytes]:
        yield b"HTTP/1.1 200 OK\r\n\r\n"
        while len(sent) < 1000:
            sent.append(1)
            yield b" " * 65536

    with scripted(endless()) as server, pytest.raises(UnexpectedAnswerError, match="1 MiB"):
        using(server.address, lambda client: client.exercises())
    assert len(sent) < 1000


@pytest.mark.long
def test_a_slow_answer_times_out(using: Using) -> None:
    released = socket.socketpair()

    def slow() -> Iterator[bytes]:
        yield b"HTTP/1.1 200 OK\r\n\r\n"
        released[0].settimeout(0.02)
        while True:
            try:
                released[0].recv(1)
                return
            except TimeoutError:
                yield b" "

    with scripted(slow(), slow(), slow()) as server:
        with pytest.raises(ServerUnreachableError, match=r"no complete answer within 0\.2 seconds"):
            using(server.address, lambda client: client.exercises(), timeout=0.2)
        assert len(server.requests) == 3
    for each in released:
        each.close()


def test_an_unreachable_server_is_a_temporary_error(using: Using) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(ServerUnreachableError, match=f"127.0.0.1:{port} cannot be reached") as it:
        using(f"http://127.0.0.1:{port}", lambda client: client.exercises())
    assert it.value.is_temporary


# --- Address


@pytest.mark.parametrize(
    ("server", "called"),
    [
        ("http://127.0.0.1:8000", "http://127.0.0.1:8000"),
        ("https://grader.example.edu/", "https://grader.example.edu"),
        ("https://example.edu:443/a/b/", "https://example.edu/a/b"),
        ("http://[::1]:8000", "http://[::1]:8000"),
    ],
)
def test_an_address_is_normalized(server: str, called: str) -> None:
    assert checked_server(server) == called


@pytest.mark.parametrize(
    "server",
    [
        "", "localhost:8000", "grader.example.edu", "ftp://example.edu", "http://", "http://x:y",
        "http://a b", "https://example.edu?a=b", "https://example.edu#a", "file:///etc",
    ],
)  # fmt: skip
def test_an_invalid_address_is_refused(server: str) -> None:
    with pytest.raises(ValueError, match="address of a server"):
        checked_server(server)


def test_a_password_in_an_address_is_refused_and_not_shown() -> None:
    with pytest.raises(ValueError, match="only scheme") as caught:
        checked_server("https://user:hunter2@example.edu")
    assert "hunter2" not in str(caught.value)


@pytest.mark.parametrize("key", ["", " ", "dhg 1", "dhg\r\nX-Admin: 1", "schlüssel", "dhg_\n"])
def test_a_key_with_invalid_characters_is_refused_and_not_shown(key: str) -> None:
    with pytest.raises(ValueError, match="The key is empty or") as caught:
        client_options("http://x", key, 1.0)
    assert not key.strip() or key.strip() not in str(caught.value)


def test_a_key_is_sent_in_the_authorization_header() -> None:
    options = client_options("http://x", "dhg_1", 1.0)
    assert options["headers"]["Authorization"] == "Bearer dhg_1"
    assert "Authorization" not in client_options("http://x", None, 1.0)["headers"]


# --- Calls


def bodies(answers: Sequence[Any]) -> list[bytes]:
    submissions = (ExerciseSubmission(exercise="x", answers={"t": each}) for each in answers)
    return [call.body or b"" for call in grade_many(submissions)]


@pytest.mark.parametrize(
    ("answer", "of_each"),
    [
        (1, MAX_SUBMISSIONS),
        ("θ" * 6_000, 21),  # 12,000 bytes of the 256 KiB
        ([[]] * 200, 24),  # 204 lists and objects in all, of 5,000
        ([0] * 1_000, 19),  # 1,001 commas in all, of 20,000
    ],
)
def test_a_request_has_as_many_submissions_as_the_service_accepts(
    answer: object, of_each: int
) -> None:
    sent = bodies([answer] * (2 * of_each + 1))
    lists = [json.loads(body)["submissions"] for body in sent]
    assert [len(each) for each in lists] == [of_each, of_each, 1]
    for body in sent:
        assert len(body) <= MAX_BODY_SIZE
        read_json(body)  # raises an error over a limit


def test_a_submission_that_is_too_large_is_sent_alone() -> None:
    assert len(bodies([1, "x" * MAX_BODY_SIZE, 1])) == 3
    assert bodies([]) == []


def test_values_that_json_lacks_arrive_as_text() -> None:
    answers = {"t": [float("nan"), float("-inf"), "\ud800", "θ"]}
    assert read_json(calls_grade("x", answers).body or b"") == {
        "answers": {"t": ["NaN", "-Infinity", "\ufffd", "θ"]}
    }


# --- Retries

RETRIES_BUSY = GraderClientError("busy", is_temporary=True)


def test_the_waits_double_up_to_the_longest_and_are_random() -> None:
    retries = Retries(number=9, first_wait=0.5, longest_wait=4.0)
    for failures, longest in enumerate((0.5, 1.0, 2.0, 4.0, 4.0), start=1):
        waits = [retries.wait(failures, RETRIES_BUSY) or 0.0 for _ in range(200)]
        assert longest / 2 <= min(waits) < 0.6 * longest
        assert 0.9 * longest < max(waits) <= longest


def test_the_default_waits_are_fifteen_seconds_in_all() -> None:
    longest = [max(Retries().wait(i, RETRIES_BUSY) or 0.0 for _ in range(500)) for i in range(1, 6)]
    assert sum(longest) == pytest.approx(15.5, rel=0.02)
    assert Retries().wait(6, RETRIES_BUSY) is None


def test_a_wait_is_at_least_as_long_as_the_service_asks() -> None:
    retries = Retries(longest_wait=20.0)
    asked = GraderClientError("busy", is_temporary=True, retry_after=20.0)
    assert 20.25 <= (retries.wait(1, asked) or 0.0) <= 20.5
    long = GraderClientError("busy", is_temporary=True, retry_after=20.1)
    assert retries.wait(1, long) is None


def test_permanent_failures_are_not_retried() -> None:
    assert Retries().wait(1, GraderClientError("no")) is None
    assert Retries(number=0).wait(1, RETRIES_BUSY) is None
