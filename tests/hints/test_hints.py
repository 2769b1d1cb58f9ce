"""Test hints: their rules, steps and choices."""

import ast
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from gettext import NullTranslations
from pathlib import Path
from string import Formatter
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from dh_grader import grading
from dh_grader import hints as picture
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.expressions import read
from dh_grader.figures.drawing import Theme
from dh_grader.grading import Submission
from dh_grader.grading.misconception import Record, all_records
from dh_grader.grading.report import Verdict, messages_of
from dh_grader.hints import (
    MOST,
    OF_COLUMN,
    RULES,
    Rule,
    Topic,
    has_hints,
    hint_step,
    may_have_hints,
    other_choices,
    rule_picture,
)
from dh_grader.kinematics import Convention, modified_link, standard_link
from dh_grader.translations import Language

from tests.docs.codes import sources
from tests.grading.diagnosis.traces import answered, exercises
from tests.grading.support.submitting import handed_in
from tests.shipped import sampled, shipped_exercises
from tests.solutions.solved import solved
from tests.together import together

# --- Rules in hints never contain values from an exercise

RECORDS = [record for record in all_records() if record.codes]
FIELDS = {"row", "x", "z", "x_before", "x_here", "z_before", "axis", "entry"}
PICTURED = [name for name, rule in RULES.items() if rule.pictured]
SVG = "{http://www.w3.org/2000/svg}"


@together("record", RECORDS)
def test_each_record_has_a_rule(record: Record) -> None:
    assert record.rule == "of_column" or record.rule in RULES, record.name


@together("rule", list(RULES.values()))
def test_a_rule_names_only_places_and_axes(rule: Rule) -> None:
    for text in (rule.look, rule.apply):
        assert {field for _, field, *_ in Formatter().parse(text) if field} <= FIELDS
    for text in (rule.look, rule.apply, rule.statement, rule.modified):
        # No number but in indices and the angles of a full turn: it might be the value of a cell.
        assert not re.findall(r"(?<![a-z\d+-])\d+(?!\d|°|π)", text)


def test_each_column_has_its_own_picture() -> None:
    assert [RULES[name].pictured for name in OF_COLUMN.values()] == [(name,) for name in OF_COLUMN]


@pytest.mark.parametrize("convention", Convention)
def test_the_drawn_frames_follow_the_convention(convention: Convention) -> None:
    link = standard_link if convention is Convention.STANDARD else modified_link
    expected = link(picture._LENGTH, picture._TWIST, picture._OFFSET, picture._ANGLE)
    scene = picture._scene(convention)
    np.testing.assert_allclose(scene.after, expected[:3, [0, 2, 3]], atol=1e-12)
    for name, size in (("a", picture._LENGTH), ("d", picture._OFFSET)):
        first, last = scene.length(name)
        assert np.linalg.norm(last - first) == pytest.approx(size)
    for name in ("alpha", "theta"):
        _, axis, first, last = scene.angle(name)
        size = picture._TWIST if name == "alpha" else picture._ANGLE
        # By Rodrigues' formula, turning about the axis leads from the first direction to the last.
        turned = first * np.cos(size) + np.cross(axis, first) * np.sin(size)
        np.testing.assert_allclose(turned, last, atol=1e-12)


@pytest.mark.parametrize("convention", Convention)
def test_a_picture_names_the_axes_and_the_parameter(convention: Convention) -> None:
    for name in PICTURED:
        root = ElementTree.fromstring(rule_picture(name, convention, Theme.LIGHT))
        texts = ["".join(text.itertext()) for text in root.iter(f"{SVG}text")]
        assert {"zi−1", "xi−1", "zi", "xi"} <= set(texts)
        assert len(texts) == 4 + len(RULES[name].pictured)
        assert float(root.attrib["width"]) <= 352
    twist = rule_picture("link_twist", convention, Theme.LIGHT)
    assert ("αi−1" in re.sub(r"<[^>]+>", "", twist)) == (convention is Convention.MODIFIED)


class German(NullTranslations):
    """A German translation of a single title."""

    def gettext(self, message: str) -> str:
        return "Gliedlänge a" if message == "Link length a" else message


def test_the_text_alternative_of_a_picture_is_in_the_language() -> None:
    german = Language("de", "Deutsch", "de")
    german.__dict__["translation"] = German()
    drawn = rule_picture("link_length", Convention.STANDARD, Theme.LIGHT, german)
    assert [each.text for each in ElementTree.fromstring(drawn).iter(f"{SVG}title")] == [
        "Gliedlänge a"
    ]
    assert "z_{i-1}" in drawn


# --- A hint names the axes of a table row

HINTS = FeedbackLevel.HINTS
TWIST = Topic("table", "half_turn", "2", "alpha")
STANDARD = "a1 0 0 θ1\na2 π 0 θ2"
STEPS_RECORDS = [record for record in all_records() if record.codes and record.example]


def steps_of(exercise: Exercise, answer: Any, topic: Topic) -> list[str]:
    answers = {topic.part: answer}
    report = handed_in(exercise, answers, feedback=HINTS)
    [told] = [each for each in report.parts if each.part == topic.part]
    found = [hint_step(exercise, topic, step, answers, told) for step in (1, 2, 3)]
    return [each.text for each in found if each]


def test_the_steps_name_the_axes_of_a_standard_row(catalogue: Mapping[str, Exercise]) -> None:
    look, rule, apply = steps_of(catalogue["planar-rr"], STANDARD, TWIST)
    # Spong, Hutchinson, Vidyasagar, section 3.2: α_i is from z_{i-1} to z_i about x_i.
    assert look.startswith("Look at z1 and z2")
    assert rule.startswith("α_i is the angle from z_{i-1} to z_i about x_i,")
    assert "thumb along x2. Turn z1 until it points as z2" in apply


def test_the_steps_name_the_axes_of_a_modified_row(catalogue: Mapping[str, Exercise]) -> None:
    table = "0 0 0 θ1\n0 90° 0 θ2\na2 0 d3 θ3\na3 -90° d4 θ4\n0 90° 0 θ5\n0 -90° 0 θ6"
    topic = replace(TWIST, code="sign")
    look, rule, apply = steps_of(catalogue["puma-560-craig"], table, topic)
    # Craig, section 3.4: α_{i-1} is from z_{i-1} to z_i about x_{i-1}.
    assert look.startswith("Look at z1 and z2")
    assert "about x_{i-1}," in rule
    assert "thumb along x1. Turn z1 until it points as z2" in apply


def test_a_message_that_the_report_does_not_have_has_no_hint(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue["planar-rr"]
    for other in ({"code": "sign"}, {"row": "1"}, {"cell": "a"}, {"row": None, "cell": None}):
        assert steps_of(exercise, STANDARD, replace(TWIST, **other)) == []
    assert steps_of(exercise, "a1 0 0 θ1\na2 0 0 θ2", TWIST) == []


def test_a_hint_may_be_asked_for_each_code_of_a_mistake() -> None:
    # Findings on mistakes have the default severity, and a reading error is made by another
    # function.
    made = [
        node
        for text in sources(Path(grading.__file__).parent).values()
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "Finding"
    ]
    codes = {
        each.args[0].value
        for each in made
        # The engine adds the code of a record to a finding without a code.
        if isinstance(each.args[0], ast.Constant)
        and isinstance(each.args[0].value, str)
        and each.args[0].value
        and not {"severity", "reading"} & {keyword.arg for keyword in each.keywords}
    }
    assert "slip_elsewhere" in codes
    asked = [Topic("table", code) for code in codes]
    assert [topic for topic in asked if not may_have_hints(topic, {"table": "0"})] == []


def test_an_unreadable_or_empty_cell_has_no_hint(catalogue: Mapping[str, Exercise]) -> None:
    rows = [{"a": "sin(", "alpha": "", "d": 0, "theta": "theta1"}, {"a": "a2"}]
    report = handed_in(catalogue["planar-rr"], {"table": {"rows": rows}}, feedback=HINTS)
    told = list(messages_of(report.parts[0]))
    assert {verdict for *_, verdict in told} <= {Verdict.UNREADABLE, Verdict.MISSING}
    assert len(told) >= 2
    assert not any(has_hints(message, verdict) for message, _, verdict in told)


@pytest.mark.long
@together("record", STEPS_RECORDS)
def test_each_message_on_a_mistake_has_all_steps(record: Record) -> None:
    assert record.example is not None
    name, part, answer, *_ = record.example
    exercise = exercises()[name]
    answers = {part: answered(name, part, answer)}
    report = handed_in(exercise, answers, feedback=HINTS)
    for found in report.parts:
        for message, places, verdict in messages_of(found):
            if has_hints(message, verdict):
                first = places[0] if places else None
                place = (first.row, first.cell) if first else (None, None)
                topic = Topic(found.part, message.code, *place)
                assert may_have_hints(topic, answers)
                steps = [hint_step(exercise, topic, k, answers, found) for k in (1, 2, 3)]
                texts = {step.text for step in steps if step}
                assert len(texts) == 3, message


def test_a_placed_frame_has_the_rules_of_its_convention(
    catalogue: Mapping[str, Exercise],
) -> None:
    frames = {"rows": [{"axis": 1}, {"axis": 3}, {"axis": 3}]}
    topic = Topic("frames", "axis_of_other_convention", "2", "axis")
    _, rule, _ = steps_of(catalogue["planar-rrr-frames"], frames, topic)
    # Craig, section 3.4: the z axis of frame {i} lies along joint axis i.
    assert rule.startswith("z_i lies along the axis of joint i,")


def test_the_row_of_the_end_effector_has_axes_of_its_own(catalogue: Mapping[str, Exercise]) -> None:
    table = "0 0 0 θ1\nl1 0 0 θ2\nl2 0 0 θ3\n0 0 0 0"
    topic = Topic("table", "distance_left_out", "e", "a")
    look, _, apply = steps_of(catalogue["planar-rrr-drawn"], table, topic)
    assert look.startswith("Look at z3 and z_e")
    assert "positive in the direction of x3" in apply


GIVEN = "0 0 0 θ1\n0 -90° d2 θ2\n0 -90° d3 0\n0 0 0 θ4\n0 -90° 0 θ5\n0 90° d6 θ6"


def test_a_wrong_mark_on_a_given_table_has_the_moves_of_its_convention(
    catalogue: Mapping[str, Exercise],
) -> None:
    topic = Topic("slip", "slip_elsewhere", "marked", "marked")
    answer = f"marked: 2.alpha\n{GIVEN}"
    look, rule, apply = steps_of(catalogue["find-the-slip-stanford"], answer, topic)
    assert look.startswith("Look at the order of the four moves in a row")
    assert rule.startswith("Modified convention: turn by α_{i-1} about x_{i-1}")
    assert apply.startswith("Do the four moves of one row")


def test_a_mended_table_has_the_hints_of_a_table(catalogue: Mapping[str, Exercise]) -> None:
    topic = Topic("slip", "sign", "3", "alpha")
    answer = f"marked: 3.alpha\n{GIVEN}"
    look, rule, apply = steps_of(catalogue["find-the-slip-stanford"], answer, topic)
    assert look.startswith("Look at z2 and z3")
    assert "about x_{i-1}," in rule
    assert "thumb along x2. Turn z2 until it points as z3" in apply
    # The row of the mark is none of the table: before row 1 is the base frame.
    wrong = "marked: 2.alpha\na1 90° 0 θ1\na2 180° 0 θ2\n0 0 d3 0\n0 0 d4 θ4"
    first = Topic("slip", "quarter_turn", "1", "alpha")
    assert steps_of(catalogue["find-the-slip-scara"], wrong, first)[0].startswith(
        "Look at z0 and z1"
    )


# --- The alternatives to a correct table describe the same robot as the table

COLUMNS = ("a", "alpha", "d", "theta")


def table_of(exercise: Exercise) -> DhTableSpec | None:
    tables = (part for part in exercise.parts if isinstance(part, DhTableSpec))
    free = (each for each in tables if each.frames == "free" and each.convention != "either")
    return next(free, None)


FREE = [name for name, exercise in shipped_exercises().items() if table_of(exercise)]


def model_rows(exercise: Exercise, part: DhTableSpec) -> list[dict[str, str]]:
    [found] = [each for each in solved(exercise).parts if each.part == part.id]
    answer: Any = found.answer
    return [{name: str(row[name]) for name in COLUMNS} for row in answer["rows"]]


def turn(axis: int, angle: float) -> Any:
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = np.eye(4)
    matrix[[i, j], [i, j]] = np.cos(angle)
    matrix[j, i] = np.sin(angle)
    matrix[i, j] = -np.sin(angle)
    return matrix


def move(axis: int, length: float) -> Any:
    matrix = np.eye(4)
    matrix[axis, 3] = length
    return matrix


def pose(
    rows: Sequence[Mapping[str, str]], exercise: Exercise, convention: str, numbers: Any
) -> Any:
    product = np.eye(4)
    for row in rows:
        a, alpha, d, theta = (
            float(np.squeeze(read(row[name], exercise.vocabulary).evaluate(numbers)))
            for name in COLUMNS
        )
        about_z, about_x = turn(2, theta) @ move(2, d), move(0, a) @ turn(0, alpha)
        product = product @ (about_z @ about_x if convention == "standard" else about_x @ about_z)
    return product


@pytest.mark.parametrize("exercise_id", sampled(FREE, 6))
def test_each_choice_is_another_table_of_the_same_robot(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    part = table_of(exercise)
    assert part is not None
    rows = model_rows(exercise, part)
    found = other_choices(exercise, part, rows, Submission({}))
    assert len(found) == MOST, exercise.id
    tables = [rows, *([dict(row) for row in each.rows] for each in found)]
    assert len({str(table) for table in tables}) == MOST + 1
    draw = np.random.default_rng(7)
    values = {name: draw.uniform(0.2, 1.4, 1) for name in exercise.symbols}
    if part.base == part.tool == part.directions == "given":
        expected = pose(rows, exercise, part.convention, values)
        for table in tables[1:]:
            np.testing.assert_allclose(
                pose(table, exercise, part.convention, values), expected, atol=1e-9
            )


@pytest.mark.parametrize("cell", COLUMNS)
def test_a_wrong_table_has_no_choices(cell: str, catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["planar-rr"]
    part = exercise.part("table")
    assert isinstance(part, DhTableSpec)
    rows = model_rows(exercise, part)
    rows[1] = {**rows[1], cell: "0.7"}
    assert other_choices(exercise, part, rows, Submission({})) == []


def test_given_frames_have_no_choices(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["planar-rrr-drawn"]
    part = exercise.part("table")
    assert isinstance(part, DhTableSpec)
    assert part.frames == "given"
    assert other_choices(exercise, part, model_rows(exercise, part), Submission({})) == []


def test_the_choices_of_the_planar_arm(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["planar-rr"]
    part = exercise.part("table")
    assert isinstance(part, DhTableSpec)
    rows = [
        {"a": "a1", "alpha": "0", "d": "0", "theta": "theta1"},
        {"a": "a2", "alpha": "0", "d": "0", "theta": "theta2"},
    ]
    found = other_choices(exercise, part, rows, Submission({}))
    assert [[tuple(row.values()) for row in each.rows] for each in found] == [
        [("-a1", "0", "0", "theta1 + 180°"), ("a2", "0", "0", "theta2 + 180°")],
        [("a1", "180°", "0", "theta1"), ("a2", "180°", "0", "-theta2")],
        [("a1", "0", "a1", "theta1"), ("a2", "0", "-a1", "theta2")],
    ]
