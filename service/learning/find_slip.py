"""Make a table with one random mistake, so that the grader finds exactly this mistake."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final, TypeAlias

from service.catalogue import Exercise
from service.kinematics.chain import THETA, D
from service.kinematics.dh import Convention
from service.learning.draws import SlipDraws
from service.learning.slips import SLIPS, SlipChange, changes_of
from service.learning.table_texts import ModelTable, TableCell, TableTexts, model_table
from service.time_slices import checkpoint


@dataclass(frozen=True, slots=True)
class TableBlame:
    """The grader's judgement of a wrong table.

    ``codes`` are the codes of its messages, and ``cells`` are the wrong cells. To correct the
    table, it is enough to correct any one of the cells ``single``.
    """

    codes: frozenset[str]
    cells: frozenset[TableCell]
    single: frozenset[TableCell] = frozenset()


@dataclass(frozen=True, slots=True)
class DrawnSlip:
    """A table with one mistake, which a student must find.

    ``texts`` is the wrong table, ``model`` the right table, and ``misconception`` the code of the
    mistake. ``places`` are the sets of cells that explain the mistake.
    """

    # There are several sets if parallel axes share an offset.

    misconception: str
    texts: TableTexts
    model: ModelTable
    places: tuple[frozenset[TableCell], ...]

    @property
    def cells(self) -> frozenset[TableCell]:
        """The cells in which the wrong table differs from the right table."""
        return self.places[0]


# The grader's judgement of a table at the samples of a turn; None if it is right.
JudgeTable: TypeAlias = Callable[[TableTexts, int], TableBlame | None]

# The columns in which neighbours on parallel or equal axes share an offset.
_SHARED: Final = (D, THETA)
# Tables that are judged for one draw at most.
MAX_TRIES: Final = 60
# Further samples at which the grader must find the same slip: the explanation of a few tables
# depends on the samples.
CONFIRMATIONS: Final = 5


class NoSlipError(ValueError):
    """No mistake of the wanted kind fits the robot."""


def drawn_slip(
    exercise: Exercise,
    convention: Convention,
    seed: int,
    judge_table: JudgeTable,
    wanted: str | None = None,
) -> DrawnSlip:
    """Return the table with one mistake, which ``seed`` determines.

    ``wanted`` is the code that the mistake must have, if any. Raises NoSlipError if there is no
    such table.
    """
    # The grader must find exactly one slip in the table.
    table = model_table(exercise.robot, convention, exercise.symbols)
    for _, (name, change) in zip(range(MAX_TRIES), _tries(table, seed, wanted), strict=False):
        checkpoint()
        texts = table.changed(change)
        blame = judge_table(texts, 0)
        if blame is None or not (places := _places(name, change, blame)):
            continue
        if all(judge_table(texts, turn) == blame for turn in range(1, CONFIRMATIONS + 1)):
            return DrawnSlip(name, texts, table, places)
    named = "slip" if wanted is None else f"slip {wanted}"
    raise NoSlipError(f"the {convention.value} table of this robot has no {named} to find")


def _tries(table: ModelTable, seed: int, wanted: str | None) -> Iterator[tuple[str, SlipChange]]:
    draws = SlipDraws(f"find the slip\n{seed}")
    codes = draws.shuffled(list(SLIPS)) if wanted is None else [wanted]
    left = {name: draws.shuffled(changes_of(name, table)) for name in codes}
    while any(left.values()):
        for name in codes:
            if left[name]:
                yield name, left[name].pop(0)


def _places(name: str, change: SlipChange, blame: TableBlame) -> tuple[frozenset[TableCell], ...]:
    cells = frozenset(change)
    if blame.codes != {name} or blame.cells != cells:
        return ()
    if len(cells) > 1:
        return (cells,)
    [(_, column)] = cells
    others = sorted(blame.single - cells)
    if others and (column not in _SHARED or any(other != column for _, other in others)):
        return ()
    return (cells, *(frozenset({other}) for other in others))
