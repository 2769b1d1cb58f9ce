import json
import os
import re
import zipfile
from collections.abc import Callable
from html import unescape
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest
from dh_grader.catalogue import shipped_folder
from dh_grader.formats import FORMAT_NAMES, report_format
from dh_grader.formats.documents import rendered
from dh_grader.grading import Report, Submission, grade
from typer.testing import Result

from tests.formats.submissions import CLASSROOM
from tests.shipped import shipped_exercises
from tests.translations.german import messages_in, offer_german

Run = Callable[..., Result]
Save = Callable[..., Path]

ROWS = [
    {"a": 0, "alpha": 0, "d": 0, "theta": "q1"},
    {"a": "l1", "alpha": 0, "d": 0, "theta": "q2"},
    {"a": "l2", "alpha": 0, "d": 0, "theta": "q3"},
    {"a": "l3", "alpha": 0, "d": 0, "theta": 0},
]
RIGHT = {"rows": ROWS}
HALF = {"rows": [*ROWS[:2], *({**row, "a": 7, "theta": 1} for row in ROWS[2:])]}
TOML = """
angle_unit = "degrees"
[answers.table]
rows = [
    { a = 0, alpha = 360, d = 0, theta = "q1" },
    { a = "l1", alpha = 0, d = 0.0, theta = "q2" },
    { a = "l2", alpha = 0, d = 0, theta = "q3" },
    { a = "l3", alpha = 0, d = 0, theta = 0 },
]
"""


@pytest.fixture
def save(tmp_path: Path) -> Save:
    def save(content: Any, name: str = "answer.json") -> Path:
        file = tmp_path / name
        data = content if isinstance(content, bytes) else json.dumps(content).encode()
        file.write_bytes(data)
        return file

    return save


def table_only(run: Run, *arguments: object) -> Result:
    return run("grade", "--exercise", "planar-rrr", "--part", "table", *arguments)


def test_a_right_answer_passes(run: Run, save: Save) -> None:
    result = table_only(run, save({"answers": {"table": RIGHT}}))
    assert result.exit_code == 0, result.output
    assert "table (dh_table): correct, 8 / 8 points" in result.stdout
    assert "Total for planar-rrr: 8 / 8 points, 100 %" in result.stdout
    assert result.stderr == ""


def test_an_answer_below_the_pass_mark_fails(run: Run, save: Save) -> None:
    file = save({"answers": {"table": HALF}})
    result = table_only(run, file)
    assert result.exit_code == 1
    assert "partial" in result.stdout
    assert table_only(run, file, "--pass-mark", "0.1").exit_code == 0


def test_a_score_equal_to_the_pass_mark_passes(run: Run, save: Save) -> None:
    file = save({"answers": {"table": RIGHT}})
    # 8 of the exercise's 16 points
    assert run("grade", file, "--exercise", "planar-rrr", "--pass-mark", "0.5").exit_code == 0
    assert run("grade", file, "--exercise", "planar-rrr", "--pass-mark", "0.51").exit_code == 1


def test_a_report_in_german(run: Run, save: Save, monkeypatch: pytest.MonkeyPatch) -> None:
    words = {
        "{points} points": "{points} Punkte",
        "Total for {exercise}: ": "Summe für {exercise}: ",
        "{verdict}: the pass mark is {share}.": "{verdict}: zum Bestehen braucht es {share}.",
        "Passed": "Bestanden",
        "correct": "richtig",
        "no answer": "keine Antwort",
    }
    offer_german(monkeypatch, words)
    file = save({"answers": {"table": RIGHT}})
    english = table_only(run, file)
    for german in (table_only(run, file, "--lang", "de"), table_only(run, file, "--lang", "de-AT")):
        assert german.exit_code == 0, german.output
        assert "table (dh_table): richtig, 8 / 8 Punkte\n" in german.stdout
        assert "Summe für planar-rrr: 8 / 8 Punkte, 100 %\n" in german.stdout
        assert "Bestanden: zum Bestehen braucht es 80 %.\n" in german.stdout
    monkeypatch.setenv("LANG", "de_DE.UTF-8")
    assert table_only(run, file).stdout == german.stdout
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "en")
    assert table_only(run, file).stdout == english.stdout
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "de")
    assert table_only(run, file).stdout == german.stdout
    [entry] = json.loads(run("grade", "--exercise", "planar-rrr", file, "--format", "json").stdout)
    assert messages_in(entry["report"]) == ["keine Antwort"]
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "en")
    unknown = table_only(run, file, "--lang", "xx")
    assert unknown.exit_code == 2
    assert "'xx' is no language of the reports: write one of en, de" in unknown.stderr


def test_a_file_may_contain_just_the_answer_to_the_part(run: Run, save: Save) -> None:
    assert table_only(run, save(RIGHT)).exit_code == 0
    toml = TOML.replace("[answers.table]", "").replace('angle_unit = "degrees"', "")
    toml = toml.replace("360", "0")
    assert table_only(run, save(toml.encode(), "a.toml")).exit_code == 0


def test_with_a_part_the_others_neither_count_nor_are_graded(run: Run, save: Save) -> None:
    file = save({"answers": {"table": RIGHT, "pose": "nonsense"}})
    result = table_only(run, file, "--format", "json")
    [entry] = json.loads(result.stdout)
    assert [part["part"] for part in entry["report"]["parts"]] == ["table"]
    assert entry["report"]["score"] == 1


def test_toml_is_read_like_json(run: Run, save: Save) -> None:
    result = table_only(run, save(TOML.encode(), "answer.TOML"))
    assert result.exit_code == 0, result.output


def test_json_holds_exactly_the_report(run: Run, save: Save) -> None:
    answers = {"table": HALF}
    result = run(
        "grade", save({"answers": answers}), "--exercise", "planar-rrr", "--format", "json"
    )
    exercise = shipped_exercises()["planar-rrr"]
    [entry] = json.loads(result.stdout)
    assert entry["report"] == json.loads(rendered(grade(exercise, Submission(answers))))
    assert result.stderr == ""
    assert "\x1b" not in result.stdout


def test_the_worst_of_several_files_determines_the_exit_code(run: Run, save: Save) -> None:
    right, half = save(RIGHT, "right.json"), save(HALF, "half.json")
    broken = save(b"{", "broken.json")
    assert table_only(run, right, right).exit_code == 0
    assert table_only(run, right, half).exit_code == 1
    result = table_only(run, broken, right, half, "--format", "json")
    assert result.exit_code == 2
    entries = json.loads(result.stdout)
    assert [entry["file"] for entry in entries] == [str(broken), str(right), str(half)]
    assert "line 1, column 2" in entries[0]["error"]
    assert [entry["report"]["score"] for entry in entries[1:]] == [1.0, pytest.approx(0.5, abs=0.3)]


def test_the_text_format_names_each_file(run: Run, save: Save) -> None:
    right, half = save(RIGHT, "right.json"), save(HALF, "half.json")
    # A long path is wrapped.
    output = "".join(table_only(run, right, half).stdout.split())
    assert output.index("right.json") < output.index("100%") < output.index("half.json")


def test_the_feedback_level_of_the_command_precedes_that_of_the_file(run: Run, save: Save) -> None:
    full = {"answers": {"table": HALF}}
    short = save(full | {"feedback": "score"}, "short.json")
    assert "row" not in table_only(run, short).stdout
    assert "rows 3, e a" in table_only(run, short, "--feedback", "full").stdout
    assert "row" not in table_only(run, save(full), "--feedback", "score").stdout


def test_echo_shows_how_each_cell_was_read(run: Run, save: Save) -> None:
    answer = save({"answers": {"table": HALF}})
    assert "read  a" in table_only(run, answer, "--echo").stdout
    assert "read  a" not in table_only(run, answer).stdout


@pytest.mark.parametrize("output_format", ["text", "json", "csv", "html", "junit"])
def test_output_writes_the_report_to_a_file(
    run: Run, save: Save, tmp_path: Path, output_format: str
) -> None:
    target = tmp_path / "report"
    answer = save(HALF)
    on_screen = table_only(run, answer, "--format", output_format)
    to_file = table_only(run, answer, "--format", output_format, "--output", target)
    assert to_file.stdout == ""
    assert to_file.exit_code == on_screen.exit_code == 1
    assert target.read_bytes() == on_screen.stdout_bytes
    assert sorted(tmp_path.iterdir()) == sorted([answer, target])


def test_an_interrupted_run_leaves_no_incomplete_file(
    run: Run, save: Save, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = b"submission,points,max_points,score,passed,problem,messages\n"
    answer, target = save(RIGHT), save(before, "out.csv")
    graded = []

    def interrupted(*arguments: Any) -> Report:
        graded.append(arguments)
        if len(graded) == 2:
            raise KeyboardInterrupt
        return grade(*arguments)

    monkeypatch.setattr("dh_grader.formats.graded.grade", interrupted)
    result = table_only(run, answer, answer, "--format", "csv", "--output", target)
    assert result.exit_code != 0
    assert len(graded) == 2
    assert target.read_bytes() == before
    assert sorted(tmp_path.iterdir()) == sorted([answer, target])


@pytest.mark.skipif(os.name == "nt", reason="has no such device")
def test_a_device_is_written_to_and_not_replaced(run: Run, save: Save) -> None:
    assert table_only(run, save(RIGHT), "--output", os.devnull).exit_code == 0
    assert Path(os.devnull).is_char_device()


def test_a_format_for_one_submission_refuses_several(run: Run, save: Save, tmp_path: Path) -> None:
    target = tmp_path / "results.json"
    right = save(RIGHT)
    several = table_only(run, right, right, "--format", "gradescope", "--output", target)
    assert several.exit_code == 2
    assert "gradescope holds one submission, and 2 files are given" in several.stderr
    assert not target.exists()
    assert table_only(run, right, "--format", "gradescope").exit_code == 0


def test_a_platform_gets_a_result_for_an_unusable_file(run: Run, save: Save) -> None:
    result = table_only(run, save(b"{"), "--format", "prairielearn")
    assert result.exit_code == 2
    assert json.loads(result.stdout)["gradable"] is False
    assert "line 1, column 2" in result.stderr


def test_a_format_names_the_missing_variable_of_its_platform(
    run: Run, save: Save, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CLASSROOM", raising=False)
    result = table_only(run, save(RIGHT), "--format", "classroom50")
    assert result.exit_code == 2
    assert result.stderr.startswith("classroom50: ")
    assert "CLASSROOM, " in result.stderr


@pytest.mark.long
def test_formats_for_students_respect_the_feedback_level_of_the_exercise(
    run: Run, save: Save
) -> None:
    answer = save({"answers": {"table": HALF}})
    asked = save({"answers": {"table": HALF}, "feedback": "score"}, "score.json")
    greedy = save({"answers": {"table": HALF}, "feedback": "full"}, "full.json")
    assert "It should be" in table_only(run, answer, "--format", "text").stdout
    for name in ("gradescope", "html", "junit", "markdown", "github", "prairielearn"):
        told = table_only(run, answer, "--format", name).stdout
        assert "row 3, e a" in told.replace("rows", "row")
        assert "It should be" not in told
        assert "It should be" not in table_only(run, greedy, "--format", name).stdout
        assert (
            "It should be" in table_only(run, answer, "--format", name, "--feedback", "full").stdout
        )
        assert "row 3" not in table_only(run, asked, "--format", name).stdout.replace("rows", "row")


def test_visibility_is_passed_on_to_gradescope(run: Run, save: Save) -> None:
    result = table_only(
        run, save(RIGHT), "--format", "gradescope", "--visibility", "after_due_date"
    )
    assert json.loads(result.stdout)["visibility"] == "after_due_date"


@pytest.mark.skipif(os.name == "nt", reason="allows no such names")
def test_file_names_are_escaped(run: Run, save: Save) -> None:
    name = "\x1b[31m\n::set-output name=a::b\n##[error]<script>.json"
    broken = save(b"{", name)
    result = table_only(run, broken, "--format", "markdown")
    for printed in (result.stdout, result.stderr):
        assert "\x1b" not in printed
        assert not any(line.lstrip().startswith("::") for line in printed.splitlines())
        assert "##[" not in printed
    [entry] = json.loads(table_only(run, broken, "--format", "json").stdout)
    assert entry["file"] == str(broken)


def test_an_unwritable_output_is_reported(run: Run, save: Save, tmp_path: Path) -> None:
    answer = save(RIGHT)
    for output in (tmp_path / "no" / "report", answer / "report"):
        result = table_only(run, answer, "--output", output)
        assert result.exit_code == 2
        assert result.stderr.count("cannot be written") == len(result.stderr.splitlines()) == 1


def test_the_output_must_not_replace_an_input_file(run: Run, save: Save, tmp_path: Path) -> None:
    answer = save(RIGHT)
    assignment = save(b'title = "1"\n[[exercises]]\nid = "planar-rrr"\n', "homework.toml")
    other_name = tmp_path / "folder" / ".." / "answer.json"
    (tmp_path / "folder").mkdir()
    for output in (answer, other_name, assignment):
        before = output.read_bytes()
        result = run("grade", answer, "--assignment", assignment, "--output", output)
        assert result.exit_code == 2
        assert "would be overwritten" in result.stderr
        assert output.read_bytes() == before


def test_the_output_may_replace_an_earlier_output_but_no_submission(
    run: Run, save: Save, tmp_path: Path
) -> None:
    (tmp_path / "class" / "bert").mkdir(parents=True)
    command = ("grade", tmp_path / "class", "--exercise", "planar-rrr", "--format", "csv")
    for name in ("class/anna.json", "class/bert/answer.json"):
        answer = save({"answers": {"table": RIGHT}}, name)
        before = answer.read_bytes()
        refused = run(*command, "--output", answer)
        assert (refused.exit_code, answer.read_bytes()) == (2, before)
        assert "is among the submissions" in refused.stderr
    points = tmp_path / "class" / "points.csv"
    for _ in range(2):
        assert run(*command, "--output", points).exit_code == 1
        assert points.read_text(encoding="utf-8").count("\n") == 3


@pytest.mark.parametrize(
    ("option", "word", "meant"),
    [
        ("--format", "htlm", "html"),
        ("--feedback", "verdict", "verdicts"),
        ("--visibility", "visable", "visible"),
    ],
)
def test_a_mistyped_choice_gets_a_suggestion(
    run: Run, save: Save, option: str, word: str, meant: str
) -> None:
    result = table_only(run, save(RIGHT), option, word)
    assert result.exit_code == 2
    told = " ".join(result.stderr.replace("│", " ").split())
    assert f"{word!r} is not one of " in told
    assert f"Did you mean {meant}?" in told
    assert "Value error" not in told


def test_grading_a_class_in_a_format_for_one_submission_is_explained(
    run: Run, save: Save, tmp_path: Path
) -> None:
    for name in ("class/anna/answer.json", "class/bert/answer.json"):
        (tmp_path / name).parent.mkdir(parents=True)
        save({"answers": {"table": RIGHT}}, name)
    folder = tmp_path / "class"
    result = run("grade", folder, "--exercise", "planar-rrr", "--format", "gradescope")
    assert result.exit_code == 2
    assert f"so the folder {folder} was taken for that of one student" in result.stderr


def test_an_exercise_without_an_answer_is_not_called_unreadable(run: Run, save: Save) -> None:
    empty, unread = save({"answers": {}}), save({"answers": {"table": "l1 +"}}, "unread.json")
    command = ("--exercise", "planar-rrr", "--format")
    told = {
        (file.name, name): run("grade", file, *command, name).stdout
        for file in (empty, unread)
        for name in ("text", "gradescope")
    }
    for (file, _), page in told.items():
        assert ("could be read" in page) == (file == "unread.json")
        assert ("not answered" in page or "Nothing is answered" in page) == (file != "unread.json")


@pytest.mark.parametrize(
    ("content", "name", "reason"),
    [
        (b'{\n "answers": {]}', "a.json", "line 2, column 14"),
        (b"", "a.json", "is empty"),
        (b'{"a": \x81}', "a.json", "a.json is not text"),
        (b'{"a": ]}', "a.json", "is not usable JSON: Expecting value. (line 1, column 7)"),
        (b"\x81", "a.json", "a.json is not text"),
        (b"[" * 5000 + b"]" * 5000, "a.json", "deep"),
        (b" " * 300_000, "a.json", "larger than 256 KiB"),
        (b'{"answers": {"table": 1, "table": 2}}', "a.json", "twice"),
        (b'{"rows": []}', "a.json", "--part"),
        (b'{"answers": []}', "a.json", 'answers is []; write {"PART": '),
        (b'{"answers": null}', "a.json", 'answers is null; write {"PART": '),
        (b'{"answers": {}, "echo": 1}', "a.json", "echo is 1; write true or false"),
        (
            b'{"answers": {}, "angle_unit": "deg"}', "a.json",
            'angle_unit is "deg"; it may be radians, degrees. Did you mean degrees?',
        ),
        (b'{"answers": {}, "unit": "deg"}', "a.json", "unit"),
        (b'{"answers": {"tabel": 1}}', "a.json", "table, pose"),
        (b"answers = \n", "a.toml", "line 1, column 11"),
        (b"\x81", "a.toml", "a.toml is not text"),
        (b"a = " + b"[" * 5000, "a.toml", ""),
        (b"a = " + b"[" * 100 + b"]" * 100, "a.toml", "deep"),
        (b"a = " + b"9" * 5000, "a.toml", "not usable TOML: a number has thousands of digits\n"),
    ],
)  # fmt: skip
def test_an_unusable_file_says_why(
    run: Run, save: Save, content: bytes, name: str, reason: str
) -> None:
    file = save(content, name)
    result = run("grade", file, "--exercise", "planar-rrr")
    assert result.exit_code == 2
    assert result.stderr.startswith(str(file))
    assert reason in result.stderr
    assert result.stdout == ""


def test_a_missing_file_and_an_empty_folder_are_refused(run: Run, tmp_path: Path) -> None:
    missing = run("grade", tmp_path / "none.json", "--exercise", "planar-rrr")
    assert missing.exit_code == 2
    assert "No such file" in missing.stderr
    assert run("grade", tmp_path, "--exercise", "planar-rrr").exit_code == 2


def test_dates_and_nan_in_toml_affect_only_their_cells(run: Run, save: Save) -> None:
    toml = TOML.replace("d = 0.0", "d = 2024-01-01").replace('a = "l2"', "a = nan")
    result = table_only(run, save(toml.encode(), "a.toml"), "--format", "json")
    assert result.exit_code in (0, 1), result.output
    rows = json.loads(result.stdout)[0]["report"]["parts"][0]["rows"]
    assert rows[1]["cells"][0]["verdict"] == "correct"
    assert rows[2]["cells"][0]["verdict"] == "unreadable"


def test_an_unknown_exercise_gets_a_suggestion(run: Run, save: Save) -> None:
    result = run("grade", save(RIGHT), "--exercise", "planar_rrr")
    assert result.exit_code == 2
    assert "Did you mean 'planar-rrr'?" in result.stderr


def test_an_exercise_file_is_graded(run: Run, save: Save, tmp_path: Path) -> None:
    arm = tmp_path / "my-arm.toml"
    # The lengths of this arm are in another order.
    text = (shipped_folder() / "planar-rrr.toml").read_text("utf-8")
    arm.write_text(text.replace("l1", "lx").replace("l2", "l1").replace("lx", "l2"), "utf-8")
    answer = save({"answers": {"table": RIGHT}})
    assert "Total for planar-rrr: 8 / 8" in table_only(run, answer).stdout
    own = run("grade", answer, "--exercise", arm, "--part", "table", "--format", "json")
    [graded] = json.loads(own.stdout)
    assert graded["report"]["exercise"] == "my-arm"
    assert graded["report"]["score"] < 1
    missing = run("grade", answer, "--exercise", tmp_path / "none.toml")
    assert missing.exit_code == 2
    assert "none.toml: cannot be read: No such file" in missing.stderr
    nothing = run("grade", answer)
    assert nothing.exit_code == 2
    assert "--exercise ID or FILE, or --assignment F" in nothing.stderr


def test_a_server_does_not_grade_by_an_exercise_file(run: Run, save: Save, tmp_path: Path) -> None:
    arm = tmp_path / "my-arm.toml"
    arm.write_bytes((shipped_folder() / "planar-rrr.toml").read_bytes())
    given = ("--exercise", arm, "--server", "http://127.0.0.1:9")
    refused = run("grade", save({"answers": {"table": RIGHT}}), *given)
    assert refused.exit_code == 2
    assert "my-arm.toml is a file of yours" in refused.stderr


def test_a_bundle_has_the_exercise_file(run: Run, tmp_path: Path) -> None:
    arm, bundle = tmp_path / "my-arm.toml", tmp_path / "bundle.zip"
    arm.write_bytes((shipped_folder() / "planar-rrr.toml").read_bytes())
    assert run("bundle", "ci", "--exercise", arm, "--output", bundle).exit_code == 0
    with zipfile.ZipFile(bundle) as files:
        [inside] = [name for name in files.namelist() if name.endswith("exercises/my-arm.toml")]
        assert files.read(inside) == arm.read_bytes()
        [assignment] = [name for name in files.namelist() if name.endswith("assignment.toml")]
        assert b'id = "my-arm"' in files.read(assignment)


def test_an_unknown_part_gets_a_suggestion(run: Run, save: Save) -> None:
    result = run("grade", save(RIGHT), "--exercise", "planar-rrr", "--part", "tabel")
    assert result.exit_code == 2
    assert "Did you mean 'table'?" in result.stderr


@pytest.mark.parametrize(
    "arguments", [[], ["x.json"], ["x.json", "--exercise", "scara", "--pass-mark", "2"]]
)
def test_a_wrong_command_line_is_unusable_input(run: Run, arguments: list[str]) -> None:
    assert run("grade", *arguments).exit_code == 2


def test_html_writes_a_class_into_a_folder_with_an_overview(
    run: Run, save: Save, tmp_path: Path
) -> None:
    files = [save(RIGHT, "anna.json"), save(HALF, "ben.json"), save(b"{", "cleo.json")]
    folder = tmp_path / "class"
    result = table_only(run, *files, "--format", "html", "--output", folder)
    assert result.exit_code == 2
    assert result.stdout == ""
    pages = sorted(path.name for path in (folder / "reports").iterdir())
    assert pages == ["anna.html", "ben.html", "cleo.html"]
    assert "Class overview" in (folder / "index.html").read_text(encoding="utf-8")
    (folder / "mine.txt").touch()
    result = table_only(run, *files, "--format", "html", "--output", folder)
    assert result.exit_code == 2
    assert f"{folder}: holds 'mine.txt'" in result.stderr.replace("\n", "")


def test_quiet_prints_only_problems(run: Run, save: Save, tmp_path: Path) -> None:
    half, empty = save({"answers": {"table": HALF}}), save(b"", "empty.csv")
    whole = table_only(run, half, empty)
    quiet = table_only(run, half, empty, "--quiet")
    assert quiet.exit_code == whole.exit_code == 2
    assert (quiet.stdout, quiet.stderr) == ("", whole.stderr)
    assert "empty.csv" in quiet.stderr
    output = tmp_path / "points.csv"
    result = table_only(run, half, "-q", "--format", "csv", "--output", output)
    assert (result.exit_code, result.output) == (1, "")
    assert "answer.json" in output.read_text(encoding="utf-8")


WORKSHEET = (
    "\ufeffIdentifier,Full name,Status,Grade,Maximum Grade,Grade can be changed,"
    "Last modified (submission),Last modified (grade),Feedback comments\r\n"
    "Participant 1234,Ada Byron,Submitted for grading,,8.00,Yes,"
    '"Saturday, 3 October 2026, 2:05 PM",-,\r\n'
    "Participant 1235,Ben Okri,Submitted for grading,,8.00,Yes,"
    '"Saturday, 3 October 2026, 2:05 PM",-,\r\n'
    "Participant 1236,Cy Young,No submission,,8.00,Yes,-,-,\r\n"
)


def test_a_worksheet_in_the_folder_of_the_class_is_no_submission(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "class"
    (folder / "Ada Byron_1234_assignsubmission_file").mkdir(parents=True)
    table = "a, alpha, d, theta\n0, 0, 0, q1\nl1, 0, 0, q2\nl2, 0, 0, q3\nl3, 0, 0, 0\n"
    (folder / "Ada Byron_1234_assignsubmission_file" / "table.csv").write_text(table)
    (folder / "Grades.csv").write_bytes(WORKSHEET.encode())
    for _ in range(2):  # The second time, the filled worksheet is there, too.
        result = run(
            "grade", folder, "--exercise", "planar-rrr", "--part", "table", "--format", "csv",
            "--worksheet", folder / "Grades.csv",
        )  # fmt: skip
        assert len(result.stdout.splitlines()) == 2
        assert result.exit_code == 0


def test_the_page_of_a_class_leads_to_each_file_that_a_person_grades(
    run: Run, tmp_path: Path
) -> None:
    (tmp_path / "in" / "Ben Okri_1235_assignsubmission_file").mkdir(parents=True)
    photo = tmp_path / "in" / "Ben Okri_1235_assignsubmission_file" / "my table: a #1.png"
    photo.write_bytes(b"\x89PNG\r\n\x1a\n")
    result = run(
        "grade", tmp_path / "in", "--exercise", "planar-rrr", "--part", "table", "--format", "html",
        "--output", tmp_path / "out",
    )  # fmt: skip
    assert result.exit_code == 2
    [link] = re.findall(
        r'<a href="([^"]+)">Open the file</a>', (tmp_path / "out/index.html").read_text()
    )
    assert (tmp_path / "out" / unquote(link)).resolve() == photo


@pytest.mark.parametrize(
    ("name", "told", "untold"),
    [("markdown", "not graded", "0 %"), ("html", "Not graded", "Not passed")],
)
def test_what_was_not_read_has_no_score(
    name: str, told: str, untold: str, run: Run, tmp_path: Path
) -> None:
    (tmp_path / "ada.csv").write_text("see the attached file")
    result = run("grade", tmp_path / "ada.csv", "--exercise", "planar-rrr", "--part", "table",
                 "--format", name)  # fmt: skip
    assert told in result.stdout
    assert untold not in result.stdout


def test_grades_and_feedback_go_back_to_moodle(run: Run, tmp_path: Path) -> None:
    table = "a, alpha, d, theta\n0, 0, 0, q1\nl1, 0, 0, q2\nl2, 0, 0, q3\nl3, 0, 0, 0\n"
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
        archive.writestr("Ada Byron_1234_assignsubmission_file/table.csv", table)
        archive.writestr("Ben Okri_1235_assignsubmission_file/table.pdf", b"%PDF-1.4")
    (tmp_path / "Grades.csv").write_bytes(WORKSHEET.encode())
    result = run(
        "grade", tmp_path / "all.zip", "--exercise", "planar-rrr", "--part", "table", "--format",
        "html", "--output", tmp_path / "feedback.zip", "--worksheet", tmp_path / "Grades.csv",
    )  # fmt: skip
    assert result.exit_code == 2
    filled = (tmp_path / "Grades-graded.csv").read_bytes().decode()
    first = "Participant 1234,Ada Byron,Submitted for grading,"
    ada = WORKSHEET.replace(f"{first},", f"{first}8,").replace(
        "-,\r\nParticipant 1235", "-,Denavit-Hartenberg table: 8 / 8\r\nParticipant 1235"
    )
    assert filled == ada
    assert (tmp_path / "Grades.csv").read_bytes() == WORKSHEET.encode()
    lines = result.stderr.splitlines()
    [told] = [i for i, line in enumerate(lines) if "worksheet" in line]
    assert lines[told].endswith("Grade it by hand:")
    assert lines[told + 1].startswith("Ben Okri_1235: table.pdf can only be graded by hand")
    with zipfile.ZipFile(tmp_path / "feedback.zip") as archive:
        names = archive.namelist()
        assert b"table.pdf can only be graded by hand" in archive.read(names[1])
    assert names == [
        "Ada Byron_1234_assignsubmission_file_/feedback.html",
        "Ben Okri_1235_assignsubmission_file_/feedback.html",
    ]


TABLE = "a, alpha, d, theta\n0, 0, 0, q1\nl1, 0, 0, q2\nl2, 0, 0, q3\nl3, 0, 0, 0\n"
OTHER = TABLE.replace("l1", "l2")
IN_TABLE = ("--exercise", "planar-rrr", "--part", "table")


def zip_file(path: Path, members: dict[str, str | bytes]) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


OUT_OF_ZIP = "has a path in the zip file that leads out of it (../out.csv), so it was not read"


def not_read(tmp_path: Path) -> dict[str, tuple[Path, str]]:
    """Return hand-ins that no program reads: the file or folder, and the whole sentence."""
    folder = tmp_path / "in"
    for name, content in {
        "Ada Byron_1_assignsubmission_file_/table.pdf": "%PDF-1.4",
        "Ben Okri_2_assignsubmission_file_/a.csv": TABLE,
        "Ben Okri_2_assignsubmission_file_/b.csv": OTHER,
        "Cy Young_3_assignsubmission_file_/empty.csv": "",
    }.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content, encoding="utf-8")
    (folder / "Di Lee_4_assignsubmission_file_").mkdir()
    zip_file(folder / "Di Lee_4_assignsubmission_file_/mine.zip", {"../out.csv": TABLE})
    return {
        "Ada Byron_1": (
            folder / "Ada Byron_1_assignsubmission_file_",
            "table.pdf can only be graded by hand: this program cannot read .pdf",
        ),
        "Ben Okri_2": (
            folder / "Ben Okri_2_assignsubmission_file_",
            "a.csv, b.csv have answers to table that differ; leave only one of them",
        ),
        "Cy Young_3": (folder / "Cy Young_3_assignsubmission_file_", "empty.csv is empty"),
        "Di Lee_4": (
            folder / "Di Lee_4_assignsubmission_file_",
            f"mine/out.csv {OUT_OF_ZIP}",
        ),
    }


def plain(output: str, name: str) -> str:
    """Return the texts of a document without the escapes of its format."""
    if name in ("json", "jsonl") or report_format(name).is_single:
        output = output.encode().decode("unicode_escape") if "\\u" in output else output
    if name == "markdown" or report_format(name).is_single:
        output = re.sub(r"\\+([.()/_-])", r"\1", output)
    return unescape(unquote(output))


@pytest.mark.long
@pytest.mark.parametrize("name", sorted(FORMAT_NAMES))
def test_every_format_says_whose_file_was_not_read_and_why(
    name: str, run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for variable, value in CLASSROOM.items():
        monkeypatch.setenv(variable, value)
    students = not_read(tmp_path)
    taken = report_format(name)
    command = ("grade", *IN_TABLE, "--format", name, "--jobs", "1")
    results = (
        [run(*command, path) for path, _ in students.values()]
        if taken.is_single
        else [run(*command, tmp_path / "in")]
    )
    assert {result.exit_code for result in results} == {2}
    printed = "".join(plain(result.stdout, name) for result in results)
    errors = "".join(result.stderr for result in results)
    for student, (path, sentence) in students.items():
        # Standard error names the student and the file.
        [line] = [line for line in errors.splitlines() if line.endswith(sentence)]
        assert student in line
        assert str(path) in line
        # The text report shows problems only there.
        if name != "text":
            assert sentence in printed


def test_files_that_a_platform_names_after_the_student_are_told_by_the_student(
    run: Run, tmp_path: Path
) -> None:
    given = zip_file(
        tmp_path / "all.zip",
        {
            "byronada_LATE_12_771_a.csv": TABLE,
            "byronada_12_772_b.csv": OTHER,
            "okriben_13_773_a.csv": TABLE,
        },
    )
    result = run("grade", given, *IN_TABLE, "--format", "csv")
    [line] = result.stderr.splitlines()
    assert line == (
        f"{given}/byronada_12: b.csv, a.csv have answers to table that differ; leave only one of "
        "them"
    )


@pytest.mark.parametrize("name", ["csv", "html", "json", "gradescope"])
def test_the_output_replaces_only_earlier_outputs(
    name: str, run: Run, save: Save, tmp_path: Path
) -> None:
    answer, target = save(RIGHT), save(b"a;b\n1;2\n", "mine.txt")
    command = ("--format", name, "--output", target)
    refused = table_only(run, answer, *command)
    assert (refused.exit_code, target.read_bytes()) == (2, b"a;b\n1;2\n")
    assert "mine.txt exists, and is no earlier report" in refused.stderr
    assert "--force" in refused.stderr
    assert table_only(run, answer, *command, "--force").exit_code == 0
    written = target.read_bytes()
    assert written != b"a;b\n1;2\n"
    # Another report replaces it, and a report of another format, too.
    assert table_only(run, answer, *command).exit_code == 0
    assert table_only(run, answer, "--format", "text", "--output", target).exit_code == 0
    assert target.read_bytes() != written
    # An empty file is nobody's work: GitHub makes one for the summary of a job.
    target.write_bytes(b"")
    assert table_only(run, answer, *command).exit_code == 0


def test_the_output_does_not_replace_the_worksheet(run: Run, save: Save) -> None:
    sheet = save(WORKSHEET.encode(), "Grades.csv")
    result = table_only(run, save(RIGHT), "--worksheet", sheet, "--output", sheet, "--force")
    assert result.exit_code == 2
    assert "would be overwritten" in result.stderr
    assert sheet.read_bytes() == WORKSHEET.encode()


def test_earlier_outputs_in_the_folder_of_a_class_are_left_out(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "class"
    (folder / "Ada Byron_1234_assignsubmission_file").mkdir(parents=True)
    (folder / "Ada Byron_1234_assignsubmission_file" / "table.csv").write_text(TABLE)
    (folder / "Grades.csv").write_bytes(WORKSHEET.encode())
    command = ("grade", folder, *IN_TABLE)
    for output in ("points.csv", "report.txt", "feedback.zip", "pages"):
        name = {".csv": "csv", ".txt": "text"}.get(Path(output).suffix, "html")
        run(*command, "--format", name, "--output", folder / output)
    run(*command, "-q", "--worksheet", folder / "Grades.csv")
    result = run(*command, "--format", "html", "--output", tmp_path / "out")
    assert result.exit_code == 0
    assert len(list((tmp_path / "out" / "reports").iterdir())) == 1
    [line] = result.stderr.splitlines()
    assert line.startswith("6 entries are earlier outputs or worksheets, and are left out: ")
    overview = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    for name in ("points.csv", "report.txt", "feedback.zip", "pages", "Grades.csv",
                 "Grades-graded.csv"):  # fmt: skip
        assert str(folder / name) in line
        assert str(folder / name) in overview


def test_the_overview_shows_names_and_the_pages_of_students_do_not(
    run: Run, tmp_path: Path
) -> None:
    given = zip_file(
        tmp_path / "all.zip",
        {
            "Ada Byron_1234_assignsubmission_file/table.csv": TABLE,
            "Participant 1235_1235_assignsubmission_file/table.csv": TABLE,
        },
    )
    command = ("grade", given, *IN_TABLE, "--format", "html", "--output", tmp_path / "out")
    assert run(*command).exit_code == 0
    overview = tmp_path / "out" / "index.html"
    assert ">Ada Byron (Participant 1234)<" in overview.read_text(encoding="utf-8")
    assert ">Participant 1235<" in overview.read_text(encoding="utf-8")
    pages = [page.read_text(encoding="utf-8") for page in (tmp_path / "out/reports").iterdir()]
    assert "Byron" not in "".join(pages)
    # The names in a worksheet are better than those of the files.
    (tmp_path / "Grades.csv").write_text(
        "Student,ID,SIS User ID,SIS Login ID,Section,HW 1 (501)\n"
        '    Points Possible,,,,,8\n"King, Ada",12,,,,\n"Okri, Ben",13,,,,\n'
    )
    canvas = {f"{name}_771_t.csv": TABLE for name in ("kingada_12", "okriben_13")}
    run("grade", zip_file(tmp_path / "canvas.zip", {**canvas}), *IN_TABLE, "--format", "html",
        "--output", tmp_path / "canvas", "--worksheet", tmp_path / "Grades.csv")  # fmt: skip
    overview = tmp_path / "canvas" / "index.html"
    assert ">King, Ada (12)<" in overview.read_text(encoding="utf-8")


def test_the_worksheet_says_what_was_written(run: Run, tmp_path: Path) -> None:
    given = zip_file(
        tmp_path / "all.zip",
        {
            "Ada Byron_1234_assignsubmission_file/table.csv": TABLE,
            "Ben Okri_1235_assignsubmission_file/table.pdf": b"%PDF-1.4",
        },
    )
    sheet = tmp_path / "Grades.csv"
    sheet.write_bytes(WORKSHEET.encode())
    command = ("grade", given, *IN_TABLE, "--worksheet", sheet)
    first = tmp_path / "Grades-graded.csv"
    said = (
        f"{first} is written. Grades filled in: 1. Already the same: 0. Left for grading by "
        "hand: 1."
    )
    assert run(*command).stderr.splitlines()[-1] == said
    assert said not in run(*command, "--quiet").stderr
    # The tutor enters Ben's grade by hand, and grades again.
    changed = first.read_bytes().replace(b"grading,,8.00", b"grading,5,8.00")
    assert changed != first.read_bytes()
    first.write_bytes(changed)
    again = run(*command, "--quiet").stderr.splitlines()
    second = tmp_path / "Grades-graded-2.csv"
    assert first.read_bytes() == changed
    assert again[-2:] == [
        f"This file exists with other contents, and stays as it is: {first}",
        said.replace(str(first), str(second)),
    ]
    assert run(*command, "--force").exit_code == 2
    assert first.read_bytes() == second.read_bytes() != changed


def test_grades_that_a_tutor_entered_stay(run: Run, tmp_path: Path) -> None:
    given = zip_file(
        tmp_path / "all.zip", {"Ada Byron_1234_assignsubmission_file/table.csv": TABLE}
    )
    sheet = tmp_path / "Grades.csv"
    sheet.write_bytes(WORKSHEET.replace("grading,,8.00", "grading,5.00,8.00", 1).encode())
    command = ("grade", given, *IN_TABLE, "--worksheet", sheet)
    kept = run(*command)
    assert "Ada Byron_1234 (5.00 / 8)" in kept.stderr
    assert "--replace-grades" in kept.stderr
    assert "no file is written" in kept.stderr
    assert not (tmp_path / "Grades-graded.csv").exists()
    replaced = run(*command, "--replace-grades")
    assert replaced.exit_code == 0
    assert b"grading,8,8.00" in (tmp_path / "Grades-graded.csv").read_bytes()


def test_the_chosen_language_is_that_of_all_sentences_about_a_class(
    run: Run, tmp_path: Path
) -> None:
    given = zip_file(
        tmp_path / "all.zip",
        {
            "Ada Byron_1234_assignsubmission_file/table.csv": TABLE,
            "Ben Okri_1235_assignsubmission_file/a.csv": TABLE,
            "Ben Okri_1235_assignsubmission_file/b.csv": OTHER,
        },
    )
    sheet = tmp_path / "Grades.csv"
    sheet.write_bytes(WORKSHEET.encode())
    said = run("grade", given, *IN_TABLE, "--worksheet", sheet, "--lang", "de").stderr
    assert "a.csv, b.csv haben Antworten zu table, die sich unterscheiden" in said
    assert "Von Hand zu bewerten: 1." in said
    assert "1 Zeile der Bewertungstabelle bleibt" in said
    assert "hand" not in said
    assert b"Denavit-Hartenberg-Tabelle: 8 / 8" in (tmp_path / "Grades-graded.csv").read_bytes()


def test_the_worksheet_of_another_course_is_refused(run: Run, tmp_path: Path) -> None:
    given = zip_file(
        tmp_path / "all.zip",
        {f"S T{i}_{i}_assignsubmission_file/table.csv": TABLE for i in range(10, 25)},
    )
    sheet = tmp_path / "Grades.csv"
    sheet.write_bytes(WORKSHEET.encode())
    result = run("grade", given, *IN_TABLE, "--format", "csv", "--worksheet", sheet)
    assert result.exit_code == 2
    told = result.stderr.splitlines()
    assert len(told) == 2
    assert "None of the 15 submissions is in the worksheet (S T10_10, S T11_11, S T12_12" in told[0]
    assert "no file is written" in told[1]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["Grades.csv", "all.zip"]


def test_a_student_in_two_downloads_is_refused(run: Run, tmp_path: Path) -> None:
    (tmp_path / "in" / "HW3" / "Ada Byron_1234_assignsubmission_file").mkdir(parents=True)
    (tmp_path / "in" / "HW3" / "Ada Byron_1234_assignsubmission_file" / "t.csv").write_text(TABLE)
    (tmp_path / "in" / "HW3" / "Ben Okri_1235_assignsubmission_file").mkdir()
    (tmp_path / "in" / "HW3" / "Ben Okri_1235_assignsubmission_file" / "t.csv").write_text(TABLE)
    zip_file(
        tmp_path / "in" / "HW3.zip",
        {
            f"{name}_assignsubmission_file/t.csv": TABLE
            for name in ("Ada Byron_1234", "Ben Okri_1235")
        },
    )
    result = run("grade", tmp_path / "in", *IN_TABLE)
    assert result.exit_code == 2
    assert "Give only one of them." in result.stderr
