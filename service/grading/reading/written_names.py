"""Values with a name in front (y = l1 s1): their order by these names, or what is wrong with one.

A name may have several places where the textbooks differ, or none. The values are put into another
order only where each that is written names one place of its own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple, TypeAlias

from service.expressions import LIMITS, LeftSide, Vocabulary, left_side
from service.grading.feedback import Finding, reading_error, reading_note
from service.grading.reading.entry import Entry
from service.grading.reading.pasted import quoted

# The places that a name may have, from 0; None where the name says nothing of a place.
Places: TypeAlias = tuple[int, ...] | None
# The places of each of several names.
PlacesOf: TypeAlias = Callable[[Sequence[LeftSide | None], Vocabulary], list[Places]]


class Arrangement(NamedTuple):
    """``order`` has the number of the value that stands in each place.

    ``misnamed`` says by number which values name another place, where no order puts that right.
    """

    order: tuple[int, ...]
    misnamed: Mapping[int, Finding]

    @property
    def by_name(self) -> bool:
        """Whether the values stand in another order than they were written in."""
        return not self.misnamed


def name_of(value: object, vocabulary: Vocabulary) -> LeftSide | None:
    """The name in front of a value, if it is an equation."""
    if not isinstance(value, str) or len(value) > LIMITS.characters:
        return None
    return left_side(value, vocabulary)


def arranged(
    values: Sequence[object], labels: Sequence[str], places_of: PlacesOf, vocabulary: Vocabulary
) -> Arrangement | None:
    """What the names of values say of their order; None where they contradict nothing.

    ``labels`` say what is asked for in each place; there are as many values.
    """
    names = [name_of(value, vocabulary) for value in values]
    if not any(names):
        return None
    places = places_of(names, vocabulary)
    misnamed = {
        i: misnamed_value(name, labels[i])
        for i, (name, allowed) in enumerate(zip(names, places, strict=True))
        if name is not None and allowed is not None and i not in allowed
    }
    if not misnamed:
        return None
    order = _order(places, [_is_written(value) for value in values])
    return Arrangement(order, {}) if order else Arrangement((*range(len(values)),), misnamed)


def _order(places: Sequence[Places], written: Sequence[bool]) -> tuple[int, ...] | None:
    """The value for each place, those that are not written in the places that are left."""
    found: dict[int, int] = {}
    for i, is_written in enumerate(written):
        allowed = places[i]
        if is_written:
            if allowed is None or len(allowed) != 1 or allowed[0] in found:
                return None
            found[allowed[0]] = i
    left = iter([i for i, is_written in enumerate(written) if not is_written])
    return tuple(found[place] if place in found else next(left) for place in range(len(places)))


def _is_written(value: object) -> bool:
    return bool(value.strip()) if isinstance(value, str) else value is not None


def misnamed_value(name: LeftSide, asked: str) -> Finding:
    """The finding that a value has the name of another than the one that is asked for."""
    message = f"This is named {quoted(name.name)}, but {asked} is asked for here."
    return reading_error("misnamed_value", message, name.span)


def with_order_note(entries: Sequence[Entry], what: str) -> tuple[Entry, ...]:
    """Entries that were put in order, with one note on it in place of those on their equations.

    The note has no place in a text: it is told once for all of them.
    """
    note = reading_note("ordered_by_names", f"{what} were ordered by their names.")
    return tuple(
        replace(
            entry,
            findings=(*(each for each in entry.findings if each.code != "equation"), note),
        )
        for entry in entries
    )
