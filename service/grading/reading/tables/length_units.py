"""Convert the lengths in a column from the header's unit to the exercise's unit."""

from dataclasses import replace

import numpy as np

from service.expressions import Expression
from service.expressions.tree import Binary, Node, Number
from service.grading.feedback import reading_error, reading_note
from service.grading.numerics.tolerances import EXACT_VALUE, SAME_FACTOR
from service.grading.reading.absent_variables import with_absent_variables
from service.grading.reading.entry import Entry, Reader, unreadable
from service.grading.reading.tables.column_headers import Header
from service.grading.reading.tables.words import METRES
from service.translations import say


def in_unit(entry: Entry, header: Header, reader: Reader) -> Entry:
    """Convert an entry from the unit in the header to the unit of the exercise.

    Numbers are converted; formulas of letters alone stay unchanged.
    """
    # Letters mean lengths in any unit. A formula that also contains a length in numbers is
    # unreadable, because the number is ambiguous. A number is unreadable if the exercise's unit is
    # unknown.
    expression = entry.expression
    if expression is None:
        return entry
    if expression.symbols:
        return _checked_formula(entry, expression, header, reader)
    value = expression.evaluate({})
    if np.all(value == 0):
        return entry
    metres = METRES.get(reader.length_unit or "")
    if metres is None or header.metres is None:
        message = say(
            "A length in {unit} cannot be converted in this exercise. Delete `{unit}` from the "
            "header, and write lengths as the exercise does.",
            unit=header.unit,
        )
        return unreadable(reading_error("header_unit", message))
    factor = header.metres / metres
    converted = Expression(
        expression.source, _times(expression.tree, factor), expression.notes, expression.symbols
    )
    message = say(
        "Read as {number} {unit}, as the header says.",
        number=f"{float(np.max(value)):g}",
        unit=header.unit,
    )
    note = reading_note("converted_length", message)
    return replace(entry, expression=converted, findings=(*entry.findings, note))


def _times(tree: Node, factor: float) -> Node:
    # For 0.001 divide by 1000, which is exact.
    divisor = round(1 / factor)
    if divisor > 1 and abs(divisor * factor - 1) < SAME_FACTOR:
        by = Number(float(divisor), str(divisor), tree.end, tree.end)
        return Binary("/", tree, by, tree.start, tree.end)
    by = Number(factor, f"{factor:.10g}", tree.end, tree.end)
    return Binary("*", tree, by, tree.start, tree.end)


def _checked_formula(entry: Entry, expression: Expression, header: Header, reader: Reader) -> Entry:
    # An entry whose value does not double when all its lengths double contains a length in numbers.
    known = with_absent_variables(reader.vocabulary).by_name
    lengths = {name for name in expression.symbols if known[name].kind == "length"}
    values = reader.samples.values_for(expression)
    values = {name: values[name] for name in expression.symbols}
    doubled = {name: numbers * (2 if name in lengths else 1) for name, numbers in values.items()}
    once, twice = expression.evaluate(values), expression.evaluate(doubled)
    with np.errstate(all="ignore"):
        expected = 2 * np.asarray(once)
    if np.allclose(twice, expected, rtol=EXACT_VALUE, atol=EXACT_VALUE, equal_nan=True):
        return entry
    message = say(
        "The number here may be in {unit} or in the unit of the exercise. Delete `{unit}` from the "
        "header, and write lengths as the exercise does.",
        unit=header.unit,
    )
    if reader.length_unit:
        message = say(
            "The number here may be in {unit} or in {other}. Delete `{unit}` from the header, and "
            "write lengths as the exercise does.",
            unit=header.unit,
            other=reader.length_unit,
        )
    return unreadable(reading_error("header_unit", message))
