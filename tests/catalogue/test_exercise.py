"""Test what an exercise may ask, in which order, and in which shape."""

import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from dh_grader.catalogue import (
    CatalogueError,
    Exercise,
    Fault,
    by_level,
    exercise_after,
    load_exercise,
    read_exercise,
)

from tests.catalogue.test_faults import VALID, changed, write
from tests.shipped import shipped_exercises

# --- Test the messages about faulty checks (sample answers) in an exercise file

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


# --- Test the messages about faulty table rows that an exercise file gives to students

TABLE = 'title = "Table"\nconvention = "standard"\n'


def test_given_rows_are_in_the_shape_of_the_answer(tmp_path: Path) -> None:
    exercise = load_exercise(write(tmp_path, VALID.replace(TABLE, f"{TABLE}given = [2]\n")))
    shape = exercise.parts[0].shape(exercise.reference)
    assert shape.model_dump()["given"] == {"2": ["0", "0", "d2 + a1", "0"]}
    assert shape.in_words().endswith("row 2 given")


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ("given = [3]", "leave at least one of the 2 rows to the student"),
        ("given = [1, 2]", "leave at least one of the 2 rows to the student"),
        ("given = [2, 1]", "each number in given once, in order"),
        ("given = [0]", "greater than or equal to 1"),
        ('given = [1]\nframes = "free"', 'given rows need frames = "given"'),
    ],
)
def test_given_rows_that_do_not_fit_are_refused(tmp_path: Path, given: str, reason: str) -> None:
    text = VALID.replace(TABLE, f"{TABLE}{given}\n")
    with pytest.raises(CatalogueError) as refused:
        load_exercise(write(tmp_path, text))
    assert reason in str(refused.value)


def test_given_rows_are_those_of_the_robots_own_table(tmp_path: Path) -> None:
    text = VALID.replace(TABLE, 'title = "Table"\nconvention = "modified"\ngiven = [1]\n')
    with pytest.raises(CatalogueError, match='write convention = "standard"'):
        load_exercise(write(tmp_path, text))


# --- Test the order of the catalogue, and its descriptions of exercises

FILE = """
title = "A part"
source = "The lecture"
{}
statement = "Turn."
[[parts]]
id = "turn"
kind = "rotation"
title = "A turn"
prompt = "Turn."
steps = [{{ axis = "x", angle = "pi/2" }}]
"""


def exercise(name: str, fields: str = "") -> Exercise:
    return read_exercise(Path(f"{name}.toml"), FILE.format(fields))


def test_exercises_are_sorted_by_level_and_order() -> None:
    given = [
        exercise("old"),
        exercise("last", 'level = "industrial"\norder = 1'),
        exercise("c", 'level = "start"'),
        exercise("b", 'level = "start"\norder = 2'),
        exercise("a", 'level = "start"\norder = 10'),
        exercise("arm", 'level = "arms"'),
    ]
    groups = [(heading, [each.id for each in group]) for heading, group in by_level(given)]
    assert groups == [
        ("Start here", ["b", "a", "c"]),
        ("Arms", ["arm"]),
        ("Industrial robots", ["last"]),
        ("More exercises", ["old"]),
    ]
    following = {each.id: exercise_after(each.id, given) for each in given}
    assert {name: found and found.id for name, found in following.items()} == {
        "b": "a",
        "a": "c",
        "c": "arm",
        "arm": "last",
        "last": "old",
        "old": None,
    }


def test_fields_of_the_catalogue_do_not_change_the_version() -> None:
    old = exercise("old")
    new = exercise("old", 'level = "arms"\norder = 3\nminutes = 5\nsummary = "x"\nkeywords = ["y"]')
    assert new.version == old.version
    assert (new.level, new.order, new.minutes) == ("arms", 3, 5)
    assert (new.summary, new.keywords) == ("x", ("y",))
    assert (old.level, old.order, old.minutes, old.summary) == (None, None, None, "")


def test_shipped_titles_are_unique_and_name_no_convention() -> None:
    titles = [each.title for each in shipped_exercises().values()]
    assert len({title.casefold() for title in titles}) == len(titles)
    named = re.compile("standard|modified|distal|proximal", re.IGNORECASE)
    assert [title for title in titles if named.search(title)] == []


def test_shipped_exercises_have_a_place_and_a_description() -> None:
    shipped = shipped_exercises().values()
    places = [(each.level, each.order) for each in shipped]
    assert None not in {part for place in places for part in place}
    assert len(set(places)) == len(places)
    # The summary is one line, without maths that the catalogue would show as it is written.
    assert [e.id for e in shipped if not 20 <= len(e.summary) <= 110 or "$" in e.summary] == []
    assert [e.id for e in shipped if not e.minutes or not 5 <= e.minutes <= 90] == []
    assert next(iter(shipped)).id == "planar-rr"


def test_conventions_are_those_that_the_parts_ask_for() -> None:
    found = {name: each.conventions for name, each in shipped_exercises().items()}
    assert found["scara"] == ("standard",)
    assert found["planar-rrr"] == ("modified",)
    assert found["simple-twist"] == ()


def test_distal_and_proximal_are_said_once_in_brackets() -> None:
    for each in shipped_exercises().values():
        said = re.findall(r".?\b(?:distal|proximal)\b.?", each.statement)
        assert said in ([], ["(distal)"], ["(proximal)"]), each.id
        assert not re.search("distal|proximal", "".join(part.prompt for part in each.parts))


# --- Test the sentences that describe the shape of an answer, such as 4 × 4

GIVEN = "base frame, tool frame, directions given"
FREE = "standard convention; frames free"
DRAWN = "modified convention; frames"
CELLS = "the columns a, alpha, d, theta"
TRANSFORM = "a matrix of 4 rows and 4 columns"
SCREWS = "a list of screw axes, 6 numbers (ω; v) for each of 1, 2, 3"
EULER = "about z (angle), about y (angle), about z (angle)"

EXPECTED = {
    "planar-rr": [
        f"a table with the rows 1, 2 and {CELLS}; {FREE}; {GIVEN}",
        f"a list of the matrices A1, A2, each of 4 rows and 4 columns; {FREE}",
        TRANSFORM,
        "a list: x (length), y (length)",
        "a list: p_x (length), p_y (length), φ (angle)",
    ],
    "dh-conditions": ["one row with a, alpha, d, theta, or none; standard convention"] * 4,
    "spherical-wrist": [
        f"a table with the rows 4, 5, 6 and {CELLS}; {FREE}; {GIVEN}",
        TRANSFORM,
        "a matrix of 3 rows and 3 columns",
        "a list: x (length), y (length), z (length)",
        f"a list: {EULER}; ZYZ about moving axes",
    ],
    "planar-rpr-poe": [
        TRANSFORM,
        f"{SCREWS}; space frame; directions given",
        f"{SCREWS}; body frame; directions given",
        TRANSFORM,
        "a list: x (length), y (length)",
    ],
    "planar-rrr-drawn": [
        f"a table with the rows 1, 2, 3, e and {CELLS}; {DRAWN}, {GIVEN}",
        f"a list of the matrices A1, A2, A3, Ae, each of 4 rows and 4 columns; {DRAWN} given",
    ],
}


def answers(exercise: Exercise) -> list[str]:
    return [part.shape(exercise.reference).in_words() for part in exercise.parts]


@pytest.mark.parametrize("exercise_id", EXPECTED)
def test_the_shape_of_each_answer_in_words(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    assert answers(catalogue[exercise_id]) == EXPECTED[exercise_id]


def test_every_part_of_the_catalogue_has_a_sentence(catalogue: Mapping[str, Exercise]) -> None:
    for exercise in catalogue.values():
        for sentence in answers(exercise):
            assert re.fullmatch(r"(?:a|one) [^{}\[\]]+", sentence)
