"""Slips in the lengths of an answer, such as a wrong sign."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from service.grading.diagnosis.upstream.slip import Names, Slip, SlipWords, SymbolChange
from service.grading.diagnosis.upstream.slip_kinds import (
    DISTANCE_LEFT_OUT,
    LENGTHS_EXCHANGED,
    OTHER_LENGTH,
    SIGN,
)
from service.translations import say

# Robots have a handful of lengths. With more, pairs are not tried.
MAX_LENGTHS = 12


def length_slips(lengths: Sequence[str], alone: Iterable[str] = ()) -> Iterator[Slip]:
    """Yield the slips in these lengths: wrong signs, missing lengths and exchanged lengths."""
    # For the lengths alone, each of which is a whole cell of the table, only exchanges are yielded.
    in_cells = set(alone)
    for length in lengths:
        if length not in in_cells:
            yield _length_sign(length)
            yield _length_left_out(length)
    if len(lengths) <= MAX_LENGTHS:
        for one, other in combinations(lengths, 2):
            yield _exchanged(one, other)
            yield _other_length(one, other)
            yield _other_length(other, one)


def _length_sign(length: str) -> Slip:
    def words(names: Names) -> SlipWords:
        name = names.shown(length)
        clause = say("the length of one link has the wrong sign")
        hint = say(
            "The length of one link has the wrong sign: check along which axis it is measured, and "
            "which way."
        )
        if name:
            clause = say("the length {name} has the wrong sign", name=name)
            hint = say(
                "The length {name} has the wrong sign: check along which axis it is measured, and "
                "which way.",
                name=name,
            )
        correction = say("Change the sign of {name} throughout.", name=names.name(length))
        return SlipWords(clause, hint, correction)

    return Slip(SIGN, words, symbols=(SymbolChange(length, length, -1.0),))


def _length_left_out(length: str) -> Slip:
    def words(names: Names) -> SlipWords:
        name = names.shown(length)
        clause = say("the length of one link is left out")
        hint = say("The length of one link is left out: check which frames it lies between.")
        if name:
            clause = say("the length {name} is left out", name=name)
            hint = say(
                "The length {name} is left out: check which frames it lies between.", name=name
            )
        return SlipWords(clause, hint)

    return Slip(DISTANCE_LEFT_OUT, words, symbols=(SymbolChange(length, length, 0.0),))


def _exchanged(one: str, other: str) -> Slip:
    def words(names: Names) -> SlipWords:
        first, second = names.shown(one), names.shown(other)
        clause = say("the lengths of two links are exchanged")
        hint = say(
            "The lengths of two links are exchanged: check which link each of them belongs to."
        )
        if first and second:
            clause = say("the lengths {one} and {other} are exchanged", one=first, other=second)
            hint = say(
                "The lengths {one} and {other} are exchanged: check which link each of them "
                "belongs to.",
                one=first,
                other=second,
            )
        correction = say(
            "Write {one} for {other}, and {other} for {one}.",
            one=names.name(one),
            other=names.name(other),
        )
        return SlipWords(clause, hint, correction)

    return Slip(
        LENGTHS_EXCHANGED, words, symbols=(SymbolChange(one, other), SymbolChange(other, one))
    )


def _other_length(right: str, written: str) -> Slip:
    def words(names: Names) -> SlipWords:
        name = names.shown(written)
        clause = say("the length of one link stands where another length belongs")
        hint = say(
            "The length of one link stands where another length belongs: check which link it "
            "belongs to."
        )
        if name:
            clause = say("the length {name} stands where another length belongs", name=name)
            hint = say(
                "The length {name} stands where another length belongs: check which link it "
                "belongs to.",
                name=name,
            )
        return SlipWords(clause, hint, say("It is {name}.", name=names.name(right)))

    return Slip(OTHER_LENGTH, words, symbols=(SymbolChange(right, written),))
