"""The right answer to a part, and the answers that need no knowledge, by the kind of the part."""

from collections.abc import Callable, Mapping
from typing import Any, Final

from service.catalogue import Exercise
from service.solutions.kinds.dh_row import answer_dh_row, lazy_dh_row
from service.solutions.kinds.dh_table import answer_dh_table, lazy_dh_table
from service.solutions.kinds.euler_angles import answer_euler_angles, lazy_euler_angles
from service.solutions.kinds.find_slip import answer_find_slip, lazy_find_slip
from service.solutions.kinds.frames import answer_frames, lazy_frames
from service.solutions.kinds.link_transforms import answer_link_transforms, lazy_link_transforms
from service.solutions.kinds.matrix import answer_matrix, lazy_matrix
from service.solutions.kinds.position import answer_position, lazy_position
from service.solutions.kinds.rotation import answer_rotation, lazy_rotation
from service.solutions.kinds.screw_axes import answer_screw_axes, lazy_screw_axes
from service.solutions.kinds.transform import answer_transform, lazy_transform
from service.solutions.kinds.vector import answer_vector, lazy_vector
from service.solutions.model_solution import PrintedAnswer
from service.solutions.work import Work

# The functions that return the right answer.
ANSWERS: Final[Mapping[str, Callable[[Any, Work], PrintedAnswer]]] = {
    "dh_row": answer_dh_row,
    "dh_table": answer_dh_table,
    "euler_angles": answer_euler_angles,
    "find_slip": answer_find_slip,
    "frames": answer_frames,
    "link_transforms": answer_link_transforms,
    "matrix": answer_matrix,
    "position": answer_position,
    "rotation": answer_rotation,
    "screw_axes": answer_screw_axes,
    "transform": answer_transform,
    "vector": answer_vector,
}
# The functions that return answers that need no knowledge.
LAZY: Final[Mapping[str, Callable[[Any, Exercise], list[object]]]] = {
    "dh_row": lazy_dh_row,
    "dh_table": lazy_dh_table,
    "euler_angles": lazy_euler_angles,
    "find_slip": lazy_find_slip,
    "frames": lazy_frames,
    "link_transforms": lazy_link_transforms,
    "matrix": lazy_matrix,
    "position": lazy_position,
    "rotation": lazy_rotation,
    "screw_axes": lazy_screw_axes,
    "transform": lazy_transform,
    "vector": lazy_vector,
}
