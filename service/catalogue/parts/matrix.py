"""Answer kind ``matrix``: any matrix, such as a Jacobian."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from service.catalogue.files.fields import Formula
from service.catalogue.part import PartSpec
from service.catalogue.robots.formulas import WrittenFormulas, matrix_of
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import MatrixShape, matrix_shape
from service.expressions import Kind
from service.translations import say


class MatrixSpec(PartSpec):
    """Any matrix up to 6×6."""

    kind: Literal["matrix"]
    expected: Annotated[
        list[Annotated[list[Formula], Field(min_length=1, max_length=6)]],
        Field(min_length=1, max_length=6),
    ]
    """The entries, row by row."""
    quantity: Kind | list[Kind] = "number"
    """The quantity of the entries (angle, length or plain number): one word for all, or one for
    each column."""

    @property
    def quantities(self) -> tuple[tuple[Kind, ...], ...]:
        """The quantity of each entry: a length, an angle or a number."""
        columns = len(self.expected[0])
        row = (self.quantity,) * columns if isinstance(self.quantity, str) else self.quantity
        return (tuple(row),) * len(self.expected)

    def formulas(self) -> WrittenFormulas:
        """The formulas of the matrix's entries."""
        return matrix_of("expected", self.expected, self.quantities)

    def shape(self, _: Reference | None) -> MatrixShape:
        """The shape of the expected matrix."""
        return matrix_shape(len(self.expected), len(self.expected[0]))

    @model_validator(mode="after")
    def _is_rectangular(self) -> "MatrixSpec":
        columns = len(self.expected[0])
        for i, row in enumerate(self.expected):
            if len(row) != columns:
                raise ValueError(
                    say(
                        "row {number} of expected has {count} entries, row 1 has {columns}; write "
                        "rows of one length",
                        number=i + 1,
                        count=len(row),
                        columns=columns,
                    )
                )
        if not isinstance(self.quantity, str) and len(self.quantity) != columns:
            raise ValueError(
                say(
                    "quantity names {count} columns, but expected has {columns}; write one for "
                    "all or one for each column",
                    count=len(self.quantity),
                    columns=columns,
                )
            )
        return self
