"""The shape of an answer, which students see before they answer."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import BaseModel, Field

from service.expressions import Kind


class AnswerShape(BaseModel, ABC):
    """The shape of an answer. ``form`` names the kind of shape; ``posted`` is its JSON form."""

    posted: ClassVar[str]
    if TYPE_CHECKING:
        form: str

    def in_words(self) -> str:
        """Return the shape in words: "a matrix of 4 rows and 4 columns"."""
        return "; ".join(self._clauses())

    @abstractmethod
    def _clauses(self) -> Iterator[str]: ...


class MatrixShape(AnswerShape):
    """The shape of a matrix."""

    posted: ClassVar[str] = "a list of rows, each a list of entries"

    form: Literal["matrix"] = "matrix"
    columns: list[str]
    rows: list[str]

    def _clauses(self) -> Iterator[str]:
        yield f"a matrix of {len(self.rows)} rows and {len(self.columns)} columns"


class ComponentView(BaseModel):
    """One value of a list: its name and its quantity."""

    name: str
    quantity: Kind


class ListShape(AnswerShape):
    """The shape of a list of values; for Euler angles with their axes in order."""

    posted: ClassVar[str] = "a list of entries"

    form: Literal["list"] = "list"
    rows: list[str]
    components: list[ComponentView]
    sequence: str | None = Field(
        None, description='Axes such as "ZYZ"; "RPY" is Rz(α) Ry(β) Rx(γ).'
    )
    axes: Literal["moving", "fixed"] | None = None

    def _clauses(self) -> Iterator[str]:
        yield f"a list: {', '.join(f'{each.name} ({each.quantity})' for each in self.components)}"
        if self.sequence:
            yield f"{self.sequence} about {self.axes} axes"


def matrix_shape(rows: int, columns: int) -> MatrixShape:
    """Return the shape of a matrix with this number of rows and columns."""
    return MatrixShape(columns=numbered(columns), rows=numbered(rows))


def list_shape(components: Iterable[tuple[str, Kind]]) -> ListShape:
    """The shape of a list of values, each with its name and quantity."""
    views = [ComponentView(name=name, quantity=quantity) for name, quantity in components]
    return ListShape(rows=numbered(len(views)), components=views)


def numbered(count: int) -> list[str]:
    """The labels "1", "2" and so on."""
    return [str(i + 1) for i in range(count)]


def choices(**stated: str) -> Iterator[str]:
    """Yield phrases such as "frames free" and "tool frame given" from ``stated``."""
    for choice in ("free", "given"):
        names = [_NAMES.get(name, name) for name, value in stated.items() if value == choice]
        if names:
            yield f"{', '.join(names)} {choice}"


_NAMES = {"base": "base frame", "tool": "tool frame"}
