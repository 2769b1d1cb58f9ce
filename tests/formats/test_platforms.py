"""Test the formats of grading platforms."""

from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element, fromstring

import pytest
from dh_grader.formats.graded import UnusableSettingError, Visibility

from tests.formats.submissions import CLASSROOM, HOSTILE, cases, checked_json, document, graded


@pytest.mark.parametrize("case", cases())
def test_the_result_matches_the_schema(case: str) -> None:
    result = checked_json("classroom50", cases()[case])
    tests = result["tests"]
    assert len({test["test-name"] for test in tests}) == len(tests) > 0
    # Rules of the runner that are not in the schema.
    assert result["score"] == sum(test["score"] for test in tests) <= result["max-score"]
    assert result["max-score"] == sum(test["max-score"] for test in tests)
    for test in tests:
        assert test["score"] <= test["max-score"]
        assert test["passed"] == (test["score"] == test["max-score"])


def test_scores_are_hundredths_of_a_point() -> None:
    right = checked_json("classroom50", cases()["right"])
    assert (right["score"], right["max-score"]) == (1600, 1600)
    wrong = checked_json("classroom50", cases()["wrong"])
    # 3.789474 of the table's points are not rounded up.
    assert [test["score"] for test in wrong["tests"]] == [400, 700]


def test_the_runners_variables_identify_the_submission() -> None:
    result = checked_json("classroom50", cases()["right"])
    assert (result["classroom"], result["assignment"]) == ("robotics", "planar")
    assert (result["owner"], result["assignment_type"]) == ("anna", "individual")
    assert result["datetime"] == "2026-06-01T14:32:05Z"
    assert result["review"] == result["commit"] == CLASSROOM["COMMIT_URL"]
    told = {**CLASSROOM, "REVIEW_URL": "https://example.org/diff", "ASSIGNMENT_TYPE": "group"}
    del told["OWNER"]
    result = checked_json("classroom50", cases()["right"], environment={**told, "USERNAME": "bo"})
    assert (result["owner"], result["assignment_type"]) == ("bo", "group")
    assert result["review"] == "https://example.org/diff"


def test_missing_variables_are_named() -> None:
    told = {**CLASSROOM, "SUBMISSION_TAG": ""}
    del told["OWNER"]
    with pytest.raises(UnusableSettingError, match=r"not here: OWNER, SUBMISSION_TAG$"):
        document("classroom50", cases()["right"], environment=told)


# --- Test annotations for GitHub

# They are parsed as in the runner of GitHub (src/Runner.Common/ActionCommand.cs).


@dataclass(frozen=True)
class Command:
    name: str
    properties: dict[str, str]
    data: str


def unescaped(text: str, *, is_property: bool) -> str:
    pairs = [("%0D", "\r"), ("%0A", "\n")]
    pairs += [("%3A", ":"), ("%2C", ",")] if is_property else []
    for replacement, sign in [*pairs, ("%25", "%")]:
        text = text.replace(replacement, sign)
    return text


def parsed(line: str) -> Command:
    """Return the GitHub command in a line: its name, properties and message."""
    assert line.lstrip().startswith("::")
    head, _, data = line.lstrip()[2:].partition("::")
    name, _, properties = head.partition(" ")
    pairs = [each.split("=", 1) for each in properties.strip().split(",")]
    found = {key: unescaped(value, is_property=True) for key, value in pairs}
    return Command(name, found, unescaped(data, is_property=False))


def read(case: str) -> list[Command]:
    return [parsed(line) for line in document("github", cases()[case]).split("\n")[:-1]]


@pytest.mark.parametrize("case", cases())
def test_every_line_is_one_annotation(case: str) -> None:
    commands = read(case)
    # GitHub shows at most ten of each kind.
    assert 0 < len(commands) <= 10
    for command in commands:
        assert command.name in ("error", "warning", "notice")
        assert set(command.properties) <= {"file", "title"}
        assert command.properties["title"]
        assert command.data
        # A message has at most 64 KB.
        assert len(command.data.encode()) < 65_536


def test_an_annotation_has_the_messages_of_its_part() -> None:
    table, pose, total = read("wrong")
    assert table.name == "warning"
    assert table.properties == {
        "file": "folder/anna.json", "title": "Denavit-Hartenberg table: 4 / 8 points",
    }  # fmt: skip
    assert table.data.startswith("✗ row 2 alpha: ")
    *_, lost, zeros = table.data.split("\n")
    assert lost == "−2: α in row 2; −2: θ in row 3"
    assert zeros.startswith("Row 1 is worth little: ")
    assert pose.properties["title"] == "Pose of the end effector: 7 / 8 points"
    assert (total.name, total.properties["title"]) == ("error", "Not passed")
    assert total.data == "11 / 16 points, 68.7 %. 80 % is needed to pass."


def test_a_right_submission_has_only_a_notice() -> None:
    [total] = read("right")
    assert (total.name, total.properties["title"]) == ("notice", "Passed")
    assert total.data == "16 / 16 points, 100 %. 80 % is needed to pass."


def test_a_file_that_cannot_be_used_is_an_error() -> None:
    *parts, total = read("unusable")
    assert [part.name for part in parts] == ["error", "error"]
    assert (total.name, total.properties["title"]) == ("error", "Not graded")


def test_hostile_text_arrives_complete_and_as_text() -> None:
    first = read("hostile words")[0]
    # In title, file and message, all but control characters and the starts of commands.
    for word in ("/C calc'!A0", "<script>", "a||b".replace("||", " || "), "100% %0A, $x$"):
        assert word in HOSTILE
        assert word in first.properties["file"]
        assert word in first.properties["title"]
    assert "100% %0A, $x$" in read("unusable")[0].data


# --- Gradescope


@pytest.mark.parametrize("case", cases())
def test_the_result_follows_the_rules_of_gradescope(case: str) -> None:
    result = checked_json("gradescope", cases()[case])
    tests = result["tests"]
    assert len({test["name"] for test in tests}) == len(tests) > 0
    assert sum(test["score"] for test in tests) == pytest.approx(result["score"], abs=1e-5)
    for test in tests:
        assert test["score"] <= test["max_score"]
        assert (test["status"] == "passed") == (test["score"] == test["max_score"])


def test_each_part_is_a_test_that_shows_its_rows() -> None:
    result = checked_json("gradescope", cases()["wrong"])
    table, pose = result["tests"]
    assert (table["name"], table["max_score"], table["status"]) == (
        "Denavit-Hartenberg table", 8.0, "failed",
    )  # fmt: skip
    lines = table["output"].splitlines()
    assert lines[0] == "| row | a | alpha | d | theta | points |"
    assert lines[3].startswith("| 2 | ✓ | ✗ | ✓ | ✓ | 0.5 / 2.5 |")
    assert any(line.startswith("- ✗ **row 2 alpha:** ") for line in lines)
    # One wrong sign of four entries in the rotation, which is half of the 8 points.
    assert pose["score"] == 7.0
    assert result["score"] == table["score"] + 7.0


def test_an_unusable_file_earns_nothing_and_has_a_reason() -> None:
    result = checked_json("gradescope", cases()["unusable"])
    assert result["score"] == 0
    assert result["output"].startswith("Nothing could be graded: is no JSON")
    assert [test["max_score"] for test in result["tests"]] == [8.0, 8.0]


def test_exercises_of_an_assignment_are_weighted() -> None:
    result = checked_json("gradescope", cases()["assignment"])
    told = [(test["name"], test["score"], test["max_score"]) for test in result["tests"]]
    arm = "Planar RRR arm"
    assert told == [
        (f"{arm}: Denavit-Hartenberg table", 1.5, 1.5),
        (f"{arm}: Pose of the end effector", 1.5, 1.5),
        ("Other arm: Table", 0.0, 1.0),
    ]
    assert result["score"] == 3.0
    # The first row has 0.5 of the exercise's 16 points, and these count 3.
    assert "| 1 | ✓ | ✓ | ✓ | ✓ | 0.09 / 0.09 |" in result["tests"][0]["output"]


def test_the_visibility_is_written() -> None:
    assert checked_json("gradescope", cases()["right"])["visibility"] == "visible"
    late = checked_json("gradescope", cases()["right"], visibility=Visibility.AFTER_PUBLISHED)
    assert late["visibility"] == "after_published"
    assert late["stdout_visibility"] == "hidden"


# --- JUnit XML follows its schema and GitLab's rules

# Schema: junit-10.xsd (https://github.com/jenkinsci/xunit-plugin). Rules of GitLab:
# https://docs.gitlab.com/ci/testing/unit_test_reports/, lib/gitlab/ci/parsers/test/junit.rb.

# For each element: its required attributes, its optional attributes, and its children.
RULES: Mapping[str, tuple[set[str], set[str], set[str]]] = {
    "testsuites": (set(), {"name", "time", "tests", "failures", "errors"}, {"testsuite"}),
    "testsuite": (
        {"name", "tests", "failures", "errors"},
        {
            "group",
            "time",
            "skipped",
            "timestamp",
            "hostname",
            "id",
            "package",
            "file",
            "log",
            "url",
        },
        {"testsuite", "properties", "testcase", "system-out", "system-err"},
    ),
    "testcase": (
        {"name"},
        {"time", "classname", "group"},
        {"skipped", "error", "failure", "system-out", "system-err"},
    ),
    "failure": (set(), {"type", "message"}, set()),
    "error": (set(), {"type", "message"}, set()),
}


def check(element: Element) -> None:
    needed, allowed, children = RULES[element.tag]
    assert needed <= set(element.attrib) <= needed | allowed
    for child in element:
        assert child.tag in children
        check(child)


def read_junit(*names: str) -> Element:
    root = fromstring(document("junit", *(cases()[name] for name in names)))
    assert root.tag == "testsuites"
    check(root)
    return root


def test_every_document_follows_the_schema() -> None:
    root = read_junit(*cases())
    keys = [(case.get("classname"), case.get("name")) for case in root.iter("testcase")]
    # GitLab drops the second of two with the same class and name.
    assert len(set(keys)) == len(keys)
    for suite in root:
        assert int(suite.get("tests", "")) == len(suite.findall("testcase")) > 0
        assert int(suite.get("failures", "")) == len(suite.findall("testcase/failure"))
        assert int(suite.get("errors", "")) == len(suite.findall("testcase/error"))
        # GitHub Actions reads numbers here.
        assert {float(each.get("time", "nan")) for each in (suite, *suite)} == {0.0}


def test_a_right_part_passes_and_a_wrong_one_fails() -> None:
    [suite] = read_junit("right")
    assert [list(case) for case in suite] == [[], []]
    [suite] = read_junit("wrong")
    table = suite[0][0]
    assert (table.tag, table.get("type")) == ("failure", "partial")
    assert table.get("message") == "partial, 4 / 8 points"
    # GitLab shows only the text.
    assert str(table.text).startswith("4 / 8 points\n✗ row 2 alpha: ")


@pytest.mark.parametrize("case", ["unreadable", "unusable"])
def test_an_unreadable_part_is_an_error(case: str) -> None:
    [suite] = read_junit(case)
    assert [[child.tag for child in each] for each in suite] == [["error"], ["error"]]


def test_without_submissions_there_is_an_empty_document() -> None:
    assert len(read_junit()) == 0


# --- Prairielearn


@pytest.mark.parametrize("case", cases())
def test_the_result_follows_the_rules_of_prairielearn(case: str) -> None:
    result = checked_json("prairielearn", cases()[case])
    for test in result.get("tests", []):
        assert test["points"] <= test["max_points"]


def test_a_score_is_a_share_of_1() -> None:
    assert checked_json("prairielearn", cases()["right"])["score"] == 1.0
    result = checked_json("prairielearn", cases()["wrong"])
    assert result["score"] == pytest.approx((4 + 7) / 16, abs=1e-6)
    table, pose = result["tests"]
    assert table["name"] == "Denavit-Hartenberg table"
    assert table["message"].startswith("✗ row 2 alpha: ")
    assert (pose["points"], pose["max_points"]) == (7.0, 8.0)


@pytest.mark.parametrize("case", ["unreadable", "hostile", "empty", "unusable"])
def test_an_unreadable_submission_is_not_gradable(case: str) -> None:
    result = checked_json("prairielearn", cases()[case])
    assert result["gradable"] is False
    assert result["score"] == 0
    assert "tests" not in result


def test_each_reason_is_given_once() -> None:
    empty = checked_json("prairielearn", cases()["empty"])
    assert empty["format_errors"] == [
        "Denavit-Hartenberg table: – Nothing was handed in.",
        "Pose of the end effector: – Nothing was handed in.",
    ]
    [reason] = checked_json("prairielearn", cases()["unusable"])["format_errors"]
    assert reason.startswith("is no JSON: =cmd")


def test_a_result_stays_below_the_limit_of_1_mb() -> None:
    rows = [
        dict.fromkeys(("a", "alpha", "d", "theta"), f"l1+{HOSTILE[:200]}{i}") for i in range(99)
    ]
    large = graded({"table": {"rows": rows}, "pose": [[HOSTILE] * 4] * 4})
    assert len(document("prairielearn", large).encode()) < 1_000_000
