"""Test the routes with which tutors export, change and delete attempts."""

import asyncio
import csv
import io
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise, load_catalogue, shipped_folder
from dh_grader.store import AttemptFilter, GradesFormat, StoreDownError
from dh_grader.store import regrades as regrade_steps
from dh_grader.store import regrades as regrading
from dh_grader.store import results as grades
from dh_grader.store.attempt_store import AttemptStore
from sqlalchemy import text

from tests.api.conftest import InProcess
from tests.attack.honest import watched
from tests.attack.interface import with_key
from tests.server.raw import HEALTH, service
from tests.store import campaign
from tests.store.recorded import LAZY, NO_TWIST, RIGHT, files_with, reader, recorded

HERE = "http://127.0.0.1:8000"
NOBODY = 32 * "0"
# The body of each route that has one.
BODIES: Mapping[str, Any] = {
    "/v1/attempts/export": None,
    f"/v1/attempts/{NOBODY}/override": {"reason": "x"},
    "/v1/learners/forget": {"learner": "nobody"},
    "/v1/exercises/scara/regrade": {},
}


@pytest.fixture
def store(tmp_path: Path) -> Iterator[AttemptStore]:
    store = AttemptStore.open(str(tmp_path / "attempts.db"))
    store.start()
    yield store
    store.close()


class Tutor:
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
def tutor(catalogue: Mapping[str, Exercise], store: AttemptStore) -> Tutor:
    return Tutor(catalogue, store)


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
    tutor: Tutor, store: AttemptStore, catalogue: Mapping[str, Exercise]
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
    tutor: Tutor, store: AttemptStore, catalogue: Mapping[str, Exercise]
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
    tutor: Tutor, store: AttemptStore, catalogue: Mapping[str, Exercise], tmp_path: Path
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
    tutor: Tutor, store: AttemptStore, catalogue: Mapping[str, Exercise], tmp_path: Path
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
    [given] = Tutor(catalogue, store).ask("GET", "/v1/attempts?learner=wrong-1").json()["attempts"]
    Tutor(catalogue, store).post(f"/v1/attempts/{given['id']}/override", points=7.5, reason="r")
    # With the same version and program nothing is outdated.
    same = Tutor(catalogue, store)
    assert same.post(path) == {"applied": False, "regraded": 0, "left": 0, "changes": []}
    # Few attempts in each step, as if they were slow.
    monkeypatch.setattr(regrade_steps, "_MOST", 4)
    monkeypatch.setattr(regrade_steps, "_PREVIEW_BATCH", 4)
    monkeypatch.setattr(regrading, "BATCH", 4)
    tutor = Tutor(corrected(tmp_path / "corrected"), store)

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
    tutor = Tutor(load_catalogue(tmp_path), store)
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
    tutor: Tutor, store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    def statuses(tutor: Tutor, **more: str) -> list[int]:
        return [tutor.asked(path, **more).status_code for path in BODIES]

    assert statuses(tutor) == [200, 404, 200, 200]
    none = [403] * len(BODIES)
    assert statuses(tutor, **{"X-Forwarded-For": "10.0.0.7"}) == none
    # A page of another origin can make a tutor's browser send requests.
    assert statuses(tutor, Origin="https://evil.example") == none
    assert statuses(tutor, Origin="null") == none
    elsewhere = "http://grader.example.edu"
    assert statuses(tutor, at=elsewhere) == none
    assert statuses(Tutor(catalogue, store, reads=False)) == none
    # If everybody may read, still only tutors may change.
    opened = Tutor(catalogue, store, reads=True)
    assert statuses(opened, at=elsewhere) == [200, 403, 403, 403]
    assert statuses(opened) == [200, 404, 200, 200]


@pytest.mark.long
def test_impossible_changes_are_refused(
    tutor: Tutor, store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    without = Tutor(catalogue, None)
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
    app = Tutor(corrected(tmp_path / "corrected"), store).app

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
