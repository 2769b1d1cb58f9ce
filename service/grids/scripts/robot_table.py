"""The DH table of a robot that a script describes."""

from dataclasses import dataclass

from service.grids.cutting.grid import Grid


@dataclass(frozen=True, slots=True)
class RobotTable:
    """The DH table of a robot, and the convention that the script names: standard or modified.

    With ``has_headers``, the first row contains headers. Otherwise the columns are a, α, d, θ.
    """

    grid: Grid
    convention: str | None = None
    has_headers: bool = False
