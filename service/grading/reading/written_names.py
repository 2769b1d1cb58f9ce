"""Sort values by their names: ``y = 2, x = 1`` is x, then y. Report wrong names."""

# A name may belong to several places, because textbooks differ, or to no place. The values are
# reordered only if each value that is not empty names exactly one place, and no two values name the
# same place.

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple, TypeAlias

from service.expressions import LIMITS, LeftSide, Vocabulary, left_side
from service.grading.feedback import Finding, reading_error, reading_note
from service.grading.reading.entry import Entry
from service.grading.reading.pasted import quoted
from service.translations import say

# The places that a name may have, counted from 0; None if the name does not imply a place.
Places: TypeAlias = tuple[int, ...] | None
# A function that returns the places of each of several names.
PlacesOf: TypeAlias = Callable[[Sequence[LeftSide | None], Vocabulary], list[Places]]


class Arrangement(NamedTuple):
    """The order of named values, or the findings on wrong names.

    ``order`` has, for each place, the index of its value. ``misnamed`` maps the index of a value
    with a wrong name to its finding.
    """

    # ``misnamed`` is empty if reordering makes all names correct.
    order: tuple[int, ...]
    misnamed: Mapping[int, Finding]

    @property
    def by_name(self) -> bool:
        """True if the values were reordered by their names."""
        return not self.misnamed


def name_of(value: object, vocabulary: Vocabulary) -> LeftSide | None:
    """Return the left side of a value such as ``y = l1 s1``; None if it is not an equation."""
    if not isinstance(value, str) or len(value) > LIMITS.characters:
        return None
    return left_side(value, vocabulary)


def arranged(
    values: Sequence[object], labels: Sequence[str], places_of: PlacesOf, vocabulary: Vocabulary
) -> Arrangement | None:
    """Return the arrangement of values by their names; None if no name is in a wrong place.

    ``labels`` are the expected names.
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
    # Empty values get the places that are left. None if a value that is not empty does not name
    # exactly one free place.
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
    """Return the finding that a value does not have the expected name."""
    message = say(
        "This is named {name}, but {asked} is asked for here.", name=quoted(name.name), asked=asked
    )
    return reading_error("misnamed_value", message, name.span)


def with_order_note(entries: Sequence[Entry], message: str) -> tuple[Entry, ...]:
    """Return sorted entries with the note ``message`` on their order."""
    # It replaces the notes on equations.
    # The note has no span, so that the report shows it once for all entries.
    note = reading_note("ordered_by_names", message)
    return tuple(
        replace(
            entry,
            findings=(*(each for each in entry.findings if each.code != "equation"), note),
        )
        for entry in entries
    )
