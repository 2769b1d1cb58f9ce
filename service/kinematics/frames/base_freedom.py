"""Keep track of the positions that a freely chosen frame 0 may still have.

Frame 0 may be turned about the axis of joint 1 and moved along this axis.

Shapes: N candidate rows, L samples; rows are ``(N, 4, L)`` with the columns a, α, d, θ.
"""

# If joint 1 is prismatic, frame 0 may be moved anywhere. The choice has an effect only where the
# chain first leaves the axis of joint 1. So the search keeps the freedom from row to row until a
# row depends on it; this row uses it up.

from dataclasses import dataclass
from typing import Self

import numpy as np

from service.kinematics.chain import THETA, A, D
from service.kinematics.frames.candidate_rows import (
    AxisRelation,
    TargetKind,
    axis_relations,
    written_or,
)
from service.kinematics.tolerances import PARALLEL
from service.kinematics.transforms import Matrices, Numbers


@dataclass(frozen=True, slots=True)
class BaseFreedom:
    """The ways in which a frame that the student chose may be moved."""

    # True if the frame may be turned about z.
    turn: bool = False
    # The frame may be moved along this vector (L, 3), given in the reference's frame on the same
    # axis.
    slide: Numbers | None = None
    # True if the frame may be moved in all directions.
    anywhere: bool = False

    @classmethod
    def on_first_axis(cls, prismatic: bool, samples: int) -> Self:
        """Return how a freely chosen frame on the axis of joint 1 may be moved."""
        return cls(turn=True, slide=None if prismatic else _along_z(samples), anywhere=prismatic)

    @property
    def is_used_up(self) -> bool:
        """True if the frame may not be moved."""
        return not (self.turn or self.anywhere) and self.slide is None

    def at_next(self, reference: Matrices, kind: TargetKind, length_scale: float) -> Self:
        """Return how the student's frame on the next axis may be moved."""
        relation = axis_relations(reference[None], length_scale)[0]
        parallel = relation != AxisRelation.SKEW
        sliding = kind is TargetKind.PRISMATIC
        turn = self.turn and (
            relation == AxisRelation.COINCIDENT or (parallel and (sliding or self.anywhere))
        )
        if self.anywhere:
            return type(self)(turn, None if sliding else _along_z(len(reference)), anywhere=sliding)
        if self.slide is None:
            return type(self)(turn)
        slide = (np.swapaxes(reference[:, :3, :3], -1, -2) @ self.slide[..., None])[..., 0]
        still_along_z = np.abs(slide[:, :2]).max() < PARALLEL
        return type(self)(turn, slide if sliding or still_along_z else None)

    def use_up(
        self, rows: Numbers, rows_beyond: Numbers, written: Numbers
    ) -> list[tuple[Numbers, Numbers]]:
        """Return rows of moved frames, each with the distance of the frame along ``slide``.

        Each distance makes one length in the row equal to the ``written`` length. Distances are
        ``(N, L)`` for N rows at L samples.
        """
        # rows_beyond is rows for a frame one unit further along slide; lengths depend linearly on
        # the distance.
        unmoved = np.zeros(rows.shape[::2])
        if self.anywhere:
            moved = rows.copy()
            moved[:, [A, D]] = written_or(written[[A, D]], rows[:, [A, D]])
            return [(moved, unmoved)]
        if self.slide is None:
            return [(rows, unmoved)]
        options = []
        for column in (A, D):
            rate = rows_beyond[:, column] - rows[:, column]
            if np.abs(rate).min() < PARALLEL or np.isnan(written[column]).any():
                continue
            distance = (written[column] - rows[:, column]) / rate
            options.append((rows + distance[:, None] * (rows_beyond - rows), distance))
        return options or [(rows, unmoved)]

    def with_written_angle(self, rows: Numbers, written: Numbers) -> Numbers:
        """Return the rows with the written θ if every angle is allowed; else unchanged."""
        if not self.turn:
            return rows
        turned = rows.copy()
        turned[:, THETA] = written_or(written[THETA], rows[:, THETA])
        return turned


def _along_z(samples: int) -> Numbers:
    return np.broadcast_to(np.array([0.0, 0.0, 1.0]), (samples, 3))
