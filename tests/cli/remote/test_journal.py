from collections.abc import Mapping
from pathlib import Path

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.cli.remote_grading import Journal, digest, journal_beside
from dh_grader.grading import Report, Submission, grade

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
