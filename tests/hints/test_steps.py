"""A hint names the axes of a table row."""

import ast
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from dh_grader import grading
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.grading.misconception import Record, all_records
from dh_grader.grading.report import Verdict, messages_of
from dh_grader.hints import Topic, has_hints, hint_step, may_have_hints

from tests.docs.codes import sources
from tests.grading.diagnosis.traces import answered, exercises
from tests.grading.support.submitting import handed_in
from tests.together import together

HINTS = FeedbackLevel.HINTS
TWIST = Topic("table", "half_turn", "2", "alpha")
STANDARD = "a1 0 0 θ1\na2 π 0 θ2"
RECORDS = [record for record in all_records() if record.codes and record.example]


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
@together("record", RECORDS)
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
