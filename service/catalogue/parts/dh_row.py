"""Answer kind ``dh_row``: the DH row of a transform, or "none" if it has no row."""

from collections.abc import Iterator
from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np

from service.catalogue.files.fields import Homogeneous
from service.catalogue.part import PartSpec
from service.catalogue.robots.formulas import (
    EXACT,
    FieldError,
    WrittenFormulas,
    check_transform,
    transform_of,
)
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import AnswerShape
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention
from service.kinematics.dh_row import dh1_residual, dh2_residual
from service.kinematics.transforms import Numbers
from service.translations import say


class DhRowShape(AnswerShape):
    """The shape of a DH row; `{"none": true}` means that the transform has no row."""

    posted: ClassVar[str] = (
        '`{"a", "alpha", "d", "theta"}`, or `{"none": true}` where the transform has none'
    )

    form: Literal["dh_row"] = "dh_row"
    columns: list[str]
    convention: Convention

    def _clauses(self) -> Iterator[str]:
        yield f"one row with {', '.join(self.columns)}, or none"
        yield f"{self.convention} convention"


class DhRowSpec(PartSpec):
    """The DH row of a given transform, or "none" if it has no row."""

    answer_fields: ClassVar[tuple[str, ...]] = ("transform",)
    # Two transforms without a row have equal answers, but are different tasks.
    compared_by_formulas: ClassVar[bool] = True

    kind: Literal["dh_row"]
    convention: Convention = Convention.STANDARD
    """"standard" (distal) or "modified" (proximal)."""
    transform: Homogeneous
    """The entries of the transform, row by row."""

    def formulas(self) -> WrittenFormulas:
        """The formulas of the transform's entries."""
        return replace(transform_of("transform", self.transform), check=self._check)

    def _check(self, field: str, numbers: Numbers) -> None:
        check_transform(field, numbers)
        transform = np.moveaxis(numbers, -1, 0)
        for condition in (dh1_residual, dh2_residual):
            residual = condition(transform, self.convention)
            holds = np.abs(residual) < EXACT
            if holds.any() and not holds.all():
                raise FieldError(
                    field, say("has a DH row for some values of its symbols and none for others")
                )

    def shape(self, _: Reference | None) -> DhRowShape:
        """Return the shape of an answer: one row, or "none"."""
        return DhRowShape(columns=list(COLUMNS), convention=self.convention)
