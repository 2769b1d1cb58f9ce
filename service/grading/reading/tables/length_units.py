"""Lengths below a header that names another unit than the exercise's: mm where it has metres."""

from dataclasses import replace

import numpy as np

from service.expressions import Expression
from service.expressions.tree import Binary, Node, Number
from service.grading.feedback import reading_error, reading_note
from service.grading.numerics.tolerances import EXACT_VALUE, SAME_FACTOR
from service.grading.reading.entry import Entry, Reader, unreadable
from service.grading.reading.tables.column_headers import METRES, Header


def in_unit(entry: Entry, header: Header, reader: Reader) -> Entry:
    """The entry, which was written in the header's unit, in the exercise's.

    A number is converted. A letter stands for a length, whatever it is measured in, so what is
    made of letters alone stays as it is. Where the two are mixed, or the exercise's unit is not
    known, the entry is unreadable: nobody can say what the number is.
    """
    expression = entry.expression
    if expression is None:
        return entry
    if expression.symbols:
        return _of_letters(entry, expression, header, reader)
    value = expression.evaluate({})
    if np.all(value == 0):
        return entry
    metres = METRES.get(reader.length_unit or "")
    if metres is None or header.metres is None:
        message = (
            f"A length in {header.unit} cannot be converted in this exercise. {_without(header)}"
        )
        return unreadable(reading_error("header_unit", message))
    factor = header.metres / metres
    converted = Expression(
        expression.source, _times(expression.tree, factor), expression.notes, expression.symbols
    )
    message = f"Read as {float(np.max(value)):g} {header.unit}, as the header says."
    note = reading_note("converted_length", message)
    return replace(entry, expression=converted, findings=(*entry.findings, note))


def _times(tree: Node, factor: float) -> Node:
    """The tree times ``factor``: dividing by 1000 is exact where multiplying by 0.001 is not."""
    divisor = round(1 / factor)
    if divisor > 1 and abs(divisor * factor - 1) < SAME_FACTOR:
        by = Number(float(divisor), str(divisor), tree.end, tree.end)
        return Binary("/", tree, by, tree.start, tree.end)
    by = Number(factor, f"{factor:.10g}", tree.end, tree.end)
    return Binary("*", tree, by, tree.start, tree.end)


def _of_letters(entry: Entry, expression: Expression, header: Header, reader: Reader) -> Entry:
    """The entry where all its lengths are letters: then it doubles when they all double."""
    values = reader.samples.values
    lengths = [symbol.name for symbol in reader.vocabulary.symbols if symbol.kind == "length"]
    doubled = {**values, **{name: 2 * values[name] for name in lengths if name in values}}
    once, twice = expression.evaluate(values, reader.samples.memo), expression.evaluate(doubled)
    with np.errstate(all="ignore"):
        expected = 2 * np.asarray(once)
    if np.allclose(twice, expected, rtol=EXACT_VALUE, atol=EXACT_VALUE, equal_nan=True):
        return entry
    unit = reader.length_unit or "the unit of the exercise"
    message = f"The number here may be in {header.unit} or in {unit}. {_without(header)}"
    return unreadable(reading_error("header_unit", message))


def _without(header: Header) -> str:
    """The advice to do without the header's unit."""
    return f"Delete `{header.unit}` from the header, and write lengths as the exercise does."
