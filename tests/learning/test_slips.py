"""Test which misconceptions about a table can be planted as mistakes."""

from collections.abc import Mapping
from dataclasses import replace
from typing import get_args

import pytest
from dh_grader.authoring import unfit_slips
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import FindSlipSpec, SlipName
from dh_grader.grading.kinds.tables import blame, slip_of
from dh_grader.grading.misconception import all_records
from dh_grader.kinematics import Convention
from dh_grader.learning import (
    SLIPS,
    NoSlipError,
    TableBlame,
    TableTexts,
    changes_of,
    drawn_slip,
    model_table,
)

# The cases about cells and tables; the one DH row of a transform is another answer kind.
OF_TABLES = {"WrongCell", "Rereadable", "WrittenTable", "StudentTable"}
NOT_DRAWN = {
    "value": "no misconception explains the cell",
    "columns_permuted": "the headings of the given table name its columns",
    "other_length_unit": "it is in all lengths at once, and most robots have letters",
    "convention_taken": "it tells how a table was read",
    "convention_not_asked_for": "it is about the convention that an answer names",
    "lost_freedom": "it tells what another slip leads to",
    "tool_not_reached": "no cell of such a table is wrong alone",
    "rows_matched": "it tells how rows were paired",
    "given_row_changed": "it is about the rows that the exercise gives",
    "extra_row": "the wrong row has no counterpart to mend",
    "row_too_many": "the wrong row has no counterpart to mend",
    "missing_row": "there is no cell to mark",
    "missing_tool_row": "there is no cell to mark",
}


def spec(name: str, convention: Convention, **fields: object) -> FindSlipSpec:
    given = {"id": name, "title": "It", "kind": "find_slip", "convention": convention}
    return FindSlipSpec.model_validate({**given, **fields})


def test_every_misconception_of_a_table_is_drawn_or_has_a_reason() -> None:
    codes = {code for each in all_records() if each.of.__name__ in OF_TABLES for code in each.codes}
    assert codes == SLIPS.keys() | NOT_DRAWN.keys()
    assert not SLIPS.keys() & NOT_DRAWN.keys()


@pytest.mark.sampled(4)
@pytest.mark.parametrize("code", SLIPS)
def test_the_scara_arm_draws_every_misconception(
    code: str, catalogue: Mapping[str, Exercise]
) -> None:
    for convention in Convention:
        part = spec(f"{code}-{convention.value}", convention, slip=code, seed=3)
        assert slip_of(part, catalogue["scara"]).misconception == code


def test_an_exercise_file_may_ask_for_each_of_them() -> None:
    assert list(get_args(SlipName)) == list(SLIPS)


def test_a_slip_that_the_robot_cannot_show_is_refused(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["planar-rr"]
    part = spec("none", Convention.STANDARD, slip="joint_variable_absent")

    def judge_table(texts: TableTexts, turn: int) -> TableBlame | None:
        return blame(part, exercise, texts, turn)

    with pytest.raises(NoSlipError, match="joint_variable_absent"):
        drawn_slip(exercise, Convention.STANDARD, 0, judge_table, part.slip)
    # A running service shows another slip, and the check of the file fails.
    assert slip_of(part, exercise).misconception in SLIPS
    [remark] = unfit_slips(replace(exercise, parts=(part,)))
    assert "joint_variable_absent" in remark.text


def test_a_change_leaves_no_cell_as_it_is(catalogue: Mapping[str, Exercise]) -> None:
    for name in ("scara", "abb-irb-6620lx", "kinova-gen3"):
        exercise = catalogue[name]
        for convention in exercise.robot.tables:
            table = model_table(exercise.robot, convention, exercise.symbols)
            for code in SLIPS:
                for change in changes_of(code, table):
                    assert change
                    assert all(table.texts[i][j] != text for (i, j), text in change.items())
