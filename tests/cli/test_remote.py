"""Test grading by a server."""

import json
import signal
from collections.abc import Mapping
from itertools import product
from pathlib import Path
from random import Random

import httpx
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.cli.remote_grading import Journal, digest, journal_beside
from dh_grader.grading import Report, Submission, grade

from tests.api.serving import Served, served
from tests.cli.conftest import Run
from tests.client.scripted import http, scripted

# --- Test ``dh-grader grade --server`` with a real server process

PAGE = (Path(__file__).parents[2] / "docs" / "client.md").read_text(encoding="utf-8")
POSITION = ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]
REFUSAL = {
    "type": "about:blank", "title": "No", "status": 422, "detail": "Not so.", "instance": "/",
}  # fmt: skip
ASSIGNMENT = """\
title = "Homework"

[[exercises]]
id = "planar-rr"
parts = ["table", "position"]
points = 10

[[exercises]]
id = "stanford-arm"
"""


@pytest.fixture
def homework(tmp_path: Path) -> Path:
    folder = tmp_path / "class"
    folder.mkdir()
    entries = [*POSITION, "q1", "a1 c1 +", "1/0", "0", 0]
    # All answers differ: the journal has equal answers only once, so that they are sent once.
    positions = Random(5).sample([*product(entries, repeat=2)], 20)
    for i, position in enumerate(positions):
        answers = {"position": position, "table": "a1, 0, 0, q1\na2, 0, 0, q2"}
        (folder / f"s{i:02}.json").write_text(json.dumps({"answers": answers}), encoding="utf-8")
    (folder / "broken.json").write_text("{", encoding="utf-8")
    (folder / "other.json").write_text('{"answers": {"tabel": 1}}', encoding="utf-8")
    (folder / "unit.json").write_text(
        json.dumps(
            {"answers": {"position": POSITION}, "angle_unit": "degrees", "feedback": "score"}
        ),
        encoding="utf-8",
    )
    return folder


def graded_posts(server: Served) -> int:
    return server.log.read_text(encoding="utf-8").count("/grade HTTP/1.1")


@pytest.mark.long
@pytest.mark.parametrize(
    "what",
    [
        ("--exercise", "planar-rr", "--format", "json", "--feedback", "hints", "--echo"),
        ("--exercise", "planar-rr", "--format", "html"),
        ("--exercise", "planar-rr", "--part", "position", "--format", "csv"),
        ("--assignment", "hw.toml", "--format", "markdown"),
    ],
    ids=lambda what: what[-1],
)
def test_a_server_and_this_program_give_the_same_document(
    run: Run, server: Served, homework: Path, monkeypatch: pytest.MonkeyPatch, what: tuple[str, ...]
) -> None:
    monkeypatch.chdir(homework.parent)
    Path("hw.toml").write_text(ASSIGNMENT, encoding="utf-8")
    here = run("grade", "class", *what, "--jobs", 1)
    there = run("grade", "class", *what, "--server", server.address, "--jobs", 3)
    assert (there.exit_code, there.stdout, there.stderr) == (2, here.stdout, here.stderr)
    assert list(Path().glob(".*")) == []


@pytest.mark.long
def test_after_a_kill_the_next_run_requests_exactly_the_rest(
    run: Run, homework: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    # Do not wait before retries.
    monkeypatch.setattr("dh_grader.client.random.uniform", lambda *_: 0.0)
    kept: list[str] = []
    add = Journal.add

    def kill_after_five(self: Journal, of: str, report: Report) -> None:
        add(self, of, report)
        kept.append(of)
        if len(kept) == 5:
            first.process.send_signal(signal.SIGKILL)
            first.process.wait()

    command = ["grade", "class", "--exercise", "planar-rr", "--format", "json", "--jobs", 2]
    command += ["--output", "points.json", "--feedback", "hints"]
    expected = run(*command, "--jobs", 1)
    whole = Path("points.json").read_text(encoding="utf-8")
    (tmp_path / "first").mkdir()
    with served(tmp_path / "first") as first:
        monkeypatch.setattr(Journal, "add", kill_after_five)
        command += ["--server", first.address]
        broken = run(*command)
        monkeypatch.setattr(Journal, "add", add)
    assert broken.exit_code == 2
    lines = broken.stderr.splitlines()
    ungraded = [line.partition(":")[0] for line in lines if " is not graded: " in line]
    # 21 can be sent; a second request may have been on its way when the server was killed.
    assert len(ungraded) == 21 - len(kept) > 10
    *_, told, advice = lines
    assert told.startswith(f"Not graded: {len(ungraded)} of 23, for {first.address} cannot be")
    assert advice.replace(".json", ".csv") in PAGE
    results = {each["file"]: each for each in json.loads(Path("points.json").read_bytes())}
    assert {
        file for file, each in results.items() if "cannot be reached" in each.get("error", "")
    } == set(ungraded)
    (tmp_path / "second").mkdir()
    with served(tmp_path / "second", DH_GRADER_PORT=str(first.port)) as second:
        again = run(*command)
    # Count after the server has stopped: the log may be written later than the answers.
    assert graded_posts(second) == len(ungraded)
    assert again.stderr == expected.stderr
    assert Path("points.json").read_text(encoding="utf-8") == whole
    assert not Path(".points.json.graded").exists()


def test_a_refused_or_failed_request_does_not_affect_other_submissions(
    run: Run, server: Served, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with httpx.Client(base_url=server.address, trust_env=False) as client:
        view = http(200, client.get("/v1/exercises/planar-rr").text)
        answers = {"answers": {"position": POSITION}}
        report = http(200, client.post("/v1/exercises/planar-rr/grade", json=answers).text)
    for name in "abc":
        # Three different answers, identified by their order alone.
        answers["answers"]["position"] = [*POSITION[:1], f"{POSITION[1]} + 0 {ord(name)}"]
        Path(f"{name}.json").write_text(json.dumps(answers), encoding="utf-8")
    command = ["grade", "a.json", "b.json", "c.json", "--exercise", "planar-rr", "--format", "csv"]
    command += ["--jobs", "1", "--server"]
    refused = http(422, json.dumps(REFUSAL))
    with scripted(view, http(500), refused, report, view, report, refused) as scripted_server:
        first = run(*command, scripted_server.address)
        assert first.exit_code == 2
        assert first.stderr.splitlines()[:3] == [
            f"a.json is not graded: {scripted_server.address} answers with the status 500.",
            "b.json is refused by the server: Not so.",
            f"Not graded: 1 of 3, for {scripted_server.address} answers with the status 500.",
        ]
        second = run(*command, scripted_server.address)
        assert second.stderr == "b.json is refused by the server: Not so.\n"
        assert len(scripted_server.requests) == 7
    assert [line.split(",")[:2] for line in second.stdout.splitlines()[1:]] == [
        ["a.json", "2"], ["b.json", ""], ["c.json", "2"],
    ]  # fmt: skip
    assert list(Path().glob(".*")) == []


def test_the_journal_separates_reports_by_key(
    run: Run, server: Served, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with httpx.Client(base_url=server.address, trust_env=False) as client:
        view = http(200, client.get("/v1/exercises/planar-rr").text)
        answers = {"answers": {"position": POSITION}}
        report = http(200, client.post("/v1/exercises/planar-rr/grade", json=answers).text)
    for name in "ab":
        answers = {"answers": {"position": [*POSITION[:1], f"{POSITION[1]} + 0 {ord(name)}"]}}
        Path(f"{name}.json").write_text(json.dumps(answers), encoding="utf-8")
    command = ["grade", "a.json", "b.json", "--exercise", "planar-rr", "--format", "csv"]
    command += ["--jobs", "1", "--server"]
    with scripted(view, report, http(500), view, report, report) as scripted_server:
        first = run(*command, scripted_server.address, "--key", "dhg_1")
        assert "Not graded: 1 of 2" in first.stderr
        run(*command, scripted_server.address, "--key", "dhg_2")
        assert len(scripted_server.requests) == 6


def test_the_environment_names_server_and_key(
    run: Run, homework: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with scripted(http(401, "<h1>who?</h1>")) as server:
        monkeypatch.setenv("DH_GRADER_SERVER", server.address)
        monkeypatch.setenv("DH_GRADER_KEY", "dhg_1")
        result = run("grade", homework, "--exercise", "planar-rr")
    assert result.exit_code == 2
    assert result.stderr == f"{server.address} answers with the status 401.\n"
    assert server.requests[0].line == "GET /v1/exercises/planar-rr HTTP/1.1"
    assert server.requests[0].headers["authorization"] == "Bearer dhg_1"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--exercise", "planar-r"), "Did you mean 'planar-rr'? Known are: "),
        (
            ("--exercise", "planar-rr", "--part", "tabel"),
            "has no part 'tabel'. Did you mean 'table'",
        ),
        (("--assignment", "hw.toml"), "exercises[0].id (line 3): There is no exercise 'own'"),
        (("--exercise", "planar-rr", "--key", "a b"), "The key is empty or has a character"),
    ],
)
def test_unknown_exercises_parts_and_keys_of_a_server_are_named(
    run: Run, server: Served, homework: Path, monkeypatch: pytest.MonkeyPatch,
    arguments: tuple[str, ...], told: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(homework.parent)
    text = 'title = "x"\n[[exercises]]\nid = "own"\n'
    Path("hw.toml").write_text(text, encoding="utf-8")
    result = run("grade", "class", "--server", server.address, *arguments)
    assert result.exit_code == 2
    assert told in result.stderr


def test_a_local_exercise_file_cannot_be_graded_by_a_server(
    run: Run, server: Served, homework: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(homework.parent)
    run("exercises", "new", "own")
    text = 'title = "x"\n[[exercises]]\npath = "own.toml"\n'
    Path("hw.toml").write_text(text, encoding="utf-8")
    result = run("grade", "class", "--assignment", "hw.toml", "--server", server.address)
    assert result.exit_code == 2
    assert "own.toml is a file of yours" in result.stderr


@pytest.mark.parametrize("address", ["localhost:8000", "", "https://u:p@example.edu"])
def test_an_invalid_server_address_is_refused(run: Run, homework: Path, address: str) -> None:
    result = run("grade", homework, "--exercise", "planar-rr", "--server", address)
    assert result.exit_code == 2
    assert "ddress of a server" in result.stderr


@pytest.mark.long
def test_failures_of_a_server_are_told_in_the_language(
    run: Run, homework: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "es")
    grade = ("grade", homework, "--exercise", "planar-rr", "--server")
    assert (
        "'localhost:8000' no es la dirección de un servidor" in run(*grade, "localhost:8000").stderr
    )
    assert "No se puede llegar a http://127.0.0.1:9: " in run(*grade, "http://127.0.0.1:9").stderr


def test_a_key_without_a_server_is_refused(run: Run, homework: Path) -> None:
    result = run("grade", homework, "--exercise", "planar-rr", "--key", "dhg_1")
    assert (result.exit_code, result.stderr) == (2, "--key goes with --server URL.\n")


# --- Journal

ONE, OTHER, THIRD = digest(["θ", 1]), digest(["θ", 2]), digest(["θ", "1"])


@pytest.fixture
def reports(catalogue: Mapping[str, Exercise]) -> tuple[Report, Report]:
    exercise = catalogue["planar-rr"]
    right = ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]
    return (
        grade(exercise, Submission({"position": right}, echo=True)),
        grade(exercise, Submission({"position": ["θ \u2028 \n +", '"']})),
    )


def test_the_next_run_reads_the_reports_of_the_previous_one(
    tmp_path: Path, reports: tuple[Report, Report]
) -> None:
    first = Journal(tmp_path / "j")
    first.add(ONE, reports[0])
    first.add(OTHER, reports[1])
    assert first.report(ONE) is None  # only reports of earlier runs are read
    second = Journal(tmp_path / "j")
    assert (second.report(ONE), second.report(OTHER)) == reports
    assert second.report(THIRD) is None
    second.remove()
    assert not (tmp_path / "j").exists()
    second.remove()


@pytest.mark.parametrize("cut", [2, 30, 120, 1000])
def test_an_incomplete_line_affects_only_itself(
    tmp_path: Path, reports: tuple[Report, Report], cut: int
) -> None:
    path = tmp_path / "j"
    journal = Journal(path)
    journal.add(ONE, reports[0])
    journal.add(OTHER, reports[1])
    path.write_bytes(path.read_bytes()[:-cut])
    Journal(path).add(THIRD, reports[1])
    last = Journal(path)
    assert last.report(ONE) == reports[0]
    assert last.report(OTHER) is None
    assert last.report(THIRD) == reports[1]


@pytest.mark.parametrize("content", [b"", b"\xff\x00", b'{"digest": "%b", "report": {}}\n'])
def test_a_file_that_is_not_a_journal_has_no_reports(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "j").write_bytes(content.replace(b"%b", ONE.encode()))
    assert Journal(tmp_path / "j").report(ONE) is None


def test_a_journal_that_cannot_be_written_is_reported_once(
    tmp_path: Path, reports: tuple[Report, Report], capsys: pytest.CaptureFixture[str]
) -> None:
    journal = Journal(tmp_path / "no such folder" / "j")
    journal.add(ONE, reports[0])
    journal.add(OTHER, reports[1])
    assert capsys.readouterr().err.count("cannot be written") == 1


def test_the_journal_is_a_hidden_file_beside_the_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "pages"
    folder.mkdir()
    assert journal_beside(tmp_path / "a/points.csv") == tmp_path / "a/.points.csv.graded"
    assert journal_beside(Path("pages/")) == Path(".pages.graded")
    monkeypatch.chdir(folder)
    assert journal_beside(Path()) == tmp_path / ".pages.graded"
    assert journal_beside(None) == Path(".dh-grader.graded")
    assert journal_beside(Path("/dev/null")) == Path(".dh-grader.graded")
