"""Test the corrections that the reader suggests for unreadable texts."""

import re
from functools import partial
from itertools import pairwise

import pytest
from dh_grader.expressions import ExpressionError, Symbol, Vocabulary, read
from dh_grader.expressions.repairs import RULES, names, numbers, texts

from tests.expressions import corpus_files
from tests.expressions.corpus_files import ROBOT, RepairCase, repair_cases
from tests.together import together

# The cases of the rule `repair_<name>` of `dh_grader.expressions.repairs` are in
# `corpus/repairs/<name>.txt`, one on each line, with the names of `ROBOT`:
#
#     text that is refused | code | from-to and the text there | repaired text, or -
#     text that is read | its meaning as normal text

DEFINED = {
    name.removeprefix("repair_"): rule
    for module in (names, numbers, texts)
    for name, rule in vars(module).items()
    if name.startswith("repair_")
}
NAMES = corpus_files.repairs()
CASES = [(name, case) for name in NAMES for case in repair_cases(name)]
REFUSED = [(name, case) for name, case in CASES if case.code]
ACCEPTED = [(name, case) for name, case in CASES if not case.code]
# Symbols that the cases of a repair need in addition to the names of the robot.
DECLARED = {"ambiguous_number": [Symbol("e1", "length"), Symbol("e", "number")]}


def vocabulary(repair: str) -> Vocabulary:
    return Vocabulary([*ROBOT.symbols, *DECLARED[repair]]) if repair in DECLARED else ROBOT


def test_every_rule_is_registered_once_and_has_cases() -> None:
    assert len(RULES) == len(DEFINED)
    assert set(RULES) == set(DEFINED.values())
    assert sorted(DEFINED) == NAMES
    assert {name for name, case in CASES if case.code} == set(NAMES)
    assert {name for name, case in CASES if not case.code} == set(NAMES)
    assert len(CASES) > 560


@together(("repair", "case"), REFUSED)
def test_a_slip_is_refused_with_its_repair(repair: str, case: RepairCase) -> None:
    names = vocabulary(repair)
    with pytest.raises(ExpressionError) as caught:
        read(case.text, names)
    error = caught.value
    assert (error.code, "-".join(map(str, error.span))) == (case.code, case.span), error.message
    assert error.suggestion == case.answer
    # A message may begin with what was written: JSON's true.
    begins = error.message[0]
    assert begins.isupper() or not begins.isalpha() or isinstance(case.text, bool), error.message
    assert error.message.endswith((".", "?")), error.message
    if case.part:
        assert str(case.text)[slice(*error.span)] == case.part
    if case.answer is not None:
        read(case.answer, names)


@pytest.mark.long
@together("repair", NAMES)
def test_a_message_never_contains_a_record_separator(repair: str) -> None:
    # The record separator counts as a blank, so a quotation in a message might contain it.
    texts = {str(case.text) for case in repair_cases(repair) if len(str(case.text)) < 30}
    split = [f"{text[:i]}\x1e{text[i:]}" for text in texts for i in range(len(text) + 1)]
    messages = [error.message for error in map(partial(_error, vocabulary(repair)), split) if error]
    assert [message for message in messages if not message.isprintable()] == []


def _error(names: Vocabulary, text: str) -> ExpressionError | None:
    try:
        read(text, names)
    except ExpressionError as error:
        return error
    return None


@together(("repair", "case"), ACCEPTED)
def test_a_similar_text_is_read(repair: str, case: RepairCase) -> None:
    assert read(case.text, vocabulary(repair)).text() == case.answer


FORMULAS = [
    *("90", "0.5", "12", "θ1+90°", "q1+90", "90+θ1", "-90°", "0.5*l1", "l1*c1+0.5", "q1-45°"),
    *("d3+0.25", "cos(q1+90°)", "l1*cos(30°)", "1.25*l1+3", "180°-q2", "2*q1", "30+15", "s1"),
]
MARKS = [
    *("'", "’", "´", "′", "‘", '"', "''", "’’", ".", ",", ";", ":", "_", "~", "!", "?", "%", "#"),
    *("°", "º", "˚", "⁰", "^o", " deg", " rad", "//", " x ", "$", "&", "@", "|", " ", "<", "="),
]
SPOILT = [
    f"{text[:i]}{mark}{text[i:]}"
    for text in FORMULAS
    for i in range(len(text) + 1)
    for mark in MARKS
]
_DIGITS = re.compile(r"[0-9]+")
_TERM = re.compile(r"(?<![\w.*/^])[0-9.]+(?=$|[-+)])")


@pytest.mark.long
@together("text", SPOILT)
def test_a_repaired_text_loses_nothing(text: str) -> None:
    error = _error(ROBOT, text)
    if error is None or error.suggestion is None:
        return
    repaired = error.suggestion
    read(repaired, ROBOT)
    written = _DIGITS.findall(text)
    joined = {first + second for first, second in pairwise(written)} - set(written)
    assert joined.isdisjoint(_DIGITS.findall(repaired)), repaired
    if error.code not in {"raised_zero", "equation"}:
        assert sum(map(len, _DIGITS.findall(repaired))) >= sum(map(len, written)), repaired
    # A unit after a variable may be removed, but then every number must have a unit.
    if error.code == "unit_on_variable" and "rad" not in text and "(" not in text:
        assert not _TERM.search(repaired), repaired
