"""Test the messages about faulty checks (sample answers) in an exercise file."""

import re
from pathlib import Path

import pytest
from dh_grader.catalogue import CatalogueError, Fault, load_exercise

from tests.catalogue.test_faults import VALID, changed, write

CHECK = """
[[checks]]
title = "Wrong"
kind = "wrong"
answers.pose = "x"
expect.pose = { points = 0 }
"""

# A replacement in the check, the expected field, and words of the expected reason.
FAULTS = {
    "unknown key": ("answers.pose", "answer.pose", "checks[0].answer", "did you mean 'answers'"),
    "no title": ('title = "Wrong"', "", "checks[0].title", "write title = …"),
    "no kind": ('kind = "wrong"', "", "checks[0].kind", "write kind = …"),
    "another kind": ('"wrong"', '"bad"', "checks[0].kind", "'right', 'equivalent' or 'wrong'"),
    "no answers": ('answers.pose = "x"', "answers = {}", "checks[0].answers", "at least 1"),
    "an answer that is not JSON": ('"x"', "1979-05-27", "checks[0].answers.pose", "JSON"),
    "another part": (
        "answers.pose",
        "answers.tool",
        "checks[0].answers.tool",
        "one of table, pose",
    ),
    "another part expected": ("expect.pose", "expect.tip", "checks[0].expect.tip", "no such part"),
    "no expectation": ("expect.pose = { points = 0 }", "", "checks[0]", "needs an expectation"),
    "an empty expectation": ("points = 0 }", "}", "checks[0].expect.pose", "write points, verdict"),
    "unknown expectation": (
        "points =",
        "marks =",
        "checks[0].expect.pose.marks",
        "points, verdict",
    ),
    "more points than there are": ("points = 0", "points = 5", "checks[0].expect.pose.points", "4"),
    "fewer than none": (
        "points = 0",
        "points = -1",
        "checks[0].expect.pose.points",
        "or equal to 0",
    ),
    "points of another type": (
        "points = 0",
        'points = "0"',
        "checks[0].expect.pose.points",
        "number",
    ),
    "another verdict": (
        "points = 0",
        'verdict = "bad"',
        "checks[0].expect.pose.verdict",
        "'partial'",
    ),
    "one code": ("points = 0", 'codes = "sign"', "checks[0].expect.pose.codes", "list"),
    "another unit": (
        'kind = "wrong"',
        'kind = "wrong"\nangle_unit = "gon"',
        "checks[0].angle_unit",
        "'radians' or 'degrees'",
    ),
}


def faults(folder: Path, text: str) -> list[Fault]:
    with pytest.raises(CatalogueError) as caught:
        load_exercise(write(folder, text))
    return caught.value.faults


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_reported_with_its_field(name: str, tmp_path: Path) -> None:
    old, new, field, reason = FAULTS[name]
    assert old in CHECK
    found = faults(tmp_path, VALID + CHECK.replace(old, new, 1))
    assert [each for each in found if each.field.startswith(field) and reason in each.reason], found
    assert all(each.line is not None and 29 < each.line < 36 for each in found)


def test_the_check_without_faults_loads(tmp_path: Path) -> None:
    [check] = load_exercise(write(tmp_path, VALID + CHECK)).checks
    assert (check.title, check.kind, check.answers) == ("Wrong", "wrong", {"pose": "x"})


def test_checks_do_not_change_the_version(tmp_path: Path) -> None:
    before = load_exercise(write(tmp_path, VALID)).version
    assert load_exercise(write(tmp_path, VALID + CHECK)).version == before


KEYS = (
    "title, source, level, order, minutes, summary, keywords, statement, robot, symbols, "
    "decimal_comma, feedback, attempts, view, vary, parts, checks, translations"
)
# A replacement, and the expected messages without the file's name; * matches anything.
MESSAGES: dict[tuple[str, str], list[str]] = {
    ("source =", "sauce ="): [
        "source: Field required: write source = …",
        f"sauce (line 2): there is no key 'sauce' here; did you mean 'source'? The keys are {KEYS}",
    ],
    ('structure = "RP"', 'structure = "RX"'): [
        "robot.structure (line 6): *: write one letter for each joint, R if it turns and P if *",
    ],
    ("points = 4", "marks = 4"): [
        "parts[1].marks (line 28): there is no key 'marks' here; did you mean 'marking'? *",
    ],
    ("range =", "limits ="): ["symbols.a1.limits (line 15): * kind, description, unit, range"],
    ('"0", "d2 + a1", "0"]', '"0", "d2 + a1"]'): [
        "robot.table[1][3] (line 11): Field required: write entry 4 as well",
    ],
    ('kind = "transform"\n', ""): ["parts[1] (line 24): *: write kind = *, one of *"],
    ('id = "pose"', 'id = "The Pose"'): ["parts[1].id (line 25): *: write small letters *"],
    ("joints =", "links = 3\njoints ="): ["robot.links (line 8): * here; the keys are *"],
}


@pytest.mark.parametrize("change", MESSAGES, ids=lambda change: str(change[1]))
def test_a_fault_says_what_to_write(change: tuple[str, str], tmp_path: Path) -> None:
    found = faults(tmp_path, changed(change))
    file = tmp_path / "arm.toml"
    said = [str(fault).removeprefix(f"{file}: ") for fault in found]
    for expected in MESSAGES[change]:
        pattern = ".*".join(map(re.escape, expected.split("*")))
        assert [each for each in said if re.fullmatch(pattern, each)], said
