"""Convert an answer to a grid of texts, and back."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from dh_grader.catalogue import Exercise, PartSpec
from dh_grader.catalogue.kinds import FindSlipSpec
from dh_grader.grading.kinds.tables import slip_of

from tests.grading.support.robots import COLUMNS

Grid = list[list[str]]


@dataclass(frozen=True)
class Sheet:
    """The labels and the shape of an answer that is written as a grid."""

    # `marked` are the cells with the slip, if the part asks for a slip; every posted answer marks
    # them.
    kind: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    marked: tuple[str, ...] = ()

    def filled(self, text: str) -> Grid:
        return [[text] * len(self.columns) for _ in self.rows]

    def posted(self, grid: Sequence[Sequence[str]]) -> Any:
        if self.kind in ("dh_table", "dh_row"):
            rows = [dict(zip(COLUMNS, row, strict=True)) for row in grid]
            return {"rows": rows} if self.kind == "dh_table" else rows[0]
        if self.kind == "find_slip":
            rows = [dict(zip(COLUMNS, row, strict=True)) for row in grid]
            return {"marked": list(self.marked), "table": {"rows": rows}}
        if self.kind == "link_transforms":
            return [list(map(list, grid[i : i + 4])) for i in range(0, len(grid), 4)]
        if self.kind == "frames":
            rows = [dict(zip(self.columns, row, strict=True)) for row in grid]
            return [{"frame": label, **row} for label, row in zip(self.rows, rows, strict=True)]
        if len(self.columns) == 1:
            return [row[0] for row in grid]
        return list(map(list, grid))

    def grid_of(self, answer: Any) -> Grid:
        if self.kind == "find_slip":
            answer = answer["table"]
        if self.kind in ("dh_table", "find_slip"):
            answer = answer["rows"]
        if self.kind == "dh_row":
            answer = [answer]
        if self.kind == "link_transforms":
            answer = [row for matrix in answer for row in matrix]
        if self.kind in ("dh_table", "dh_row", "find_slip"):
            return [[str(row[column]) for column in COLUMNS] for row in answer]
        if self.kind == "frames":
            answer = [[row["axis"], row["z"], *row["origin"], row["x"]] for row in answer]
        rows = [row if isinstance(row, list) else [row] for row in answer]
        return [list(map(str, row)) for row in rows]


def sheet_of(part: PartSpec, exercise: Exercise) -> Sheet:
    shape = dict(part.shape(exercise.reference))
    rows = tuple(shape.get("rows") or ("1",))
    if "matrices" in shape:
        rows = tuple(f"{matrix}.{row}" for matrix in shape["matrices"] for row in rows)
    marked: tuple[str, ...] = ()
    if isinstance(part, FindSlipSpec):
        cells = sorted(slip_of(part, exercise).cells)
        marked = tuple(f"{rows[i]}.{COLUMNS[j]}" for i, j in cells)
    return Sheet(part.kind, rows, tuple(shape.get("columns") or ("1",)), marked)
