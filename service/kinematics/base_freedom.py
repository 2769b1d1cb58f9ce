"""What is still open about the base frame when it is the writer's own choice.

Frame 0 may then be turned and slid along the axis of joint 1 (and moved anywhere, if that joint
slides). The choice shows only where the chain first leaves that axis, so it is carried along the
rows as a freedom and spent at the first row that depends on it.

Shapes: N continuations, L samples; rows are ``(N, 4, L)`` in the column order a, α, d, θ.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from service.kinematics.candidate_rows import PARALLEL, Place, Position, positions
from service.kinematics.chain import THETA, A, D
from service.kinematics.transforms import Matrices, Numbers


@dataclass(frozen=True, slots=True)
class BaseFreedom:
    """The freedom left at a place, in the reference's frame there.

    ``turn`` says that the frame may be turned about z; ``slide`` ``(L, 3)`` is the direction that
    it may be moved along, None for none; ``anywhere`` that it may be moved in all directions.
    """

    turn: bool = False
    slide: Numbers | None = None
    anywhere: bool = False

    @classmethod
    def on_first_axis(cls, prismatic: bool, samples: int) -> Self:
        """The freedom that a free base leaves on the axis of joint 1."""
        along_z = np.broadcast_to(np.array([0.0, 0.0, 1.0]), (samples, 3))
        return cls(turn=True, slide=None if prismatic else along_z, anywhere=prismatic)

    @property
    def spent(self) -> bool:
        """Whether nothing is left of it."""
        return not (self.turn or self.anywhere) and self.slide is None

    def beyond(self, reference: Matrices, place: Place, length_scale: float) -> Self:
        """The freedom left at the next place, ``reference`` ``(L, 4, 4)`` leading there."""
        position = positions(reference[None], length_scale)[0]
        same_line = position == Position.COINCIDENT
        parallel = position != Position.SKEW
        sliding = place is Place.PRISMATIC
        turn = self.turn and (same_line or (parallel and (sliding or self.anywhere)))
        rotation = np.swapaxes(reference[:, :3, :3], -1, -2)
        if self.anywhere:
            along_z = np.broadcast_to(np.array([0.0, 0.0, 1.0]), rotation.shape[:2])
            return type(self)(turn, None if sliding else along_z, anywhere=sliding)
        if self.slide is None:
            return type(self)(turn)
        slide = (rotation @ self.slide[..., None])[..., 0]
        still_along_z = np.abs(slide[:, :2]).max() < PARALLEL
        return type(self)(turn, slide if sliding or still_along_z else None)

    def spend(self, rows: Numbers, shifted: Numbers, own: Numbers) -> list[tuple[Numbers, Numbers]]:
        """Rows that use the freedom up, each with the way ``(N, L)`` along ``slide`` that it takes.

        ``shifted`` is what ``rows`` would be one unit further along ``slide``: lengths depend on
        the way linearly. The way is chosen so that the row comes to one length that was written.
        """
        nothing = np.zeros(rows.shape[::2])
        if self.anywhere:
            moved = rows.copy()
            for column in (A, D):
                moved[:, column] = np.where(np.isnan(own[column]), rows[:, column], own[column])
            return [(moved, nothing)]
        if self.slide is None:
            return [(rows, nothing)]
        spent = []
        for column in (A, D):
            rate = shifted[:, column] - rows[:, column]
            if np.abs(rate).min() < PARALLEL or np.isnan(own[column]).any():
                continue
            way = (own[column] - rows[:, column]) / rate
            spent.append((rows + way[:, None] * (shifted - rows), way))
        return spent or [(rows, nothing)]

    def as_written(self, rows: Numbers, own: Numbers) -> Numbers:
        """The rows with the angle that was written, where any angle would do."""
        if not self.turn:
            return rows
        written = rows.copy()
        written[:, THETA] = np.where(np.isnan(own[THETA]), rows[:, THETA], own[THETA])
        return written
