"""How fast this machine is at present."""

from time import thread_time
from typing import Final

import numpy as np

from service.kinematics.transforms import Matrices, identity, rot_x, rot_z

_ANGLES: Final = np.linspace(-3.0, 3.0, 32)
_JOINTS: Final = 6


def unit() -> float:
    """Seconds of processor time that work like a grading's takes: a small arm at 32 samples.

    The least of three: after other work, the first takes longer.
    """
    return min(_seconds() for _ in range(3))


def _seconds() -> float:
    began = thread_time()
    _pose()
    return thread_time() - began


def _pose() -> Matrices:
    pose = identity()
    for joint in range(_JOINTS):
        pose = pose @ rot_z(_ANGLES + joint) @ rot_x(joint)
    return pose
