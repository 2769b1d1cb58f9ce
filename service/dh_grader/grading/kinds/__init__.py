"""The answer kinds: the functions that read and judge the answers to a part, by its kind."""

from collections.abc import Mapping
from typing import Final

from dh_grader.grading.judging import AnswerKind
from dh_grader.grading.kinds.frames import judge_frames_answer, read_frames_answer
from dh_grader.grading.kinds.matrices import (
    judge_matrix_answer,
    judge_position_answer,
    judge_rotation_answer,
    judge_transform_answer,
    judge_vector_answer,
    read_matrix_answer,
    read_position_answer,
    read_rotation_answer,
    read_transform_answer,
    read_vector_answer,
)
from dh_grader.grading.kinds.motions import (
    judge_euler_angles_answer,
    judge_link_transforms_answer,
    judge_screw_axes_answer,
    read_euler_angles_answer,
    read_link_transforms_answer,
    read_screw_axes_answer,
)
from dh_grader.grading.kinds.tables import (
    judge_dh_row_answer,
    judge_dh_table_answer,
    judge_find_slip_answer,
    read_dh_row_answer,
    read_dh_table_answer,
    read_find_slip_answer,
)

KINDS: Final[Mapping[str, AnswerKind]] = {
    "dh_row": AnswerKind(read_dh_row_answer, judge_dh_row_answer),
    "dh_table": AnswerKind(read_dh_table_answer, judge_dh_table_answer),
    "euler_angles": AnswerKind(read_euler_angles_answer, judge_euler_angles_answer),
    "find_slip": AnswerKind(read_find_slip_answer, judge_find_slip_answer),
    "frames": AnswerKind(read_frames_answer, judge_frames_answer),
    "link_transforms": AnswerKind(read_link_transforms_answer, judge_link_transforms_answer),
    "matrix": AnswerKind(read_matrix_answer, judge_matrix_answer),
    "position": AnswerKind(read_position_answer, judge_position_answer),
    "rotation": AnswerKind(read_rotation_answer, judge_rotation_answer),
    "screw_axes": AnswerKind(read_screw_axes_answer, judge_screw_axes_answer),
    "transform": AnswerKind(read_transform_answer, judge_transform_answer),
    "vector": AnswerKind(read_vector_answer, judge_vector_answer),
}
