"""Test the records of all misconceptions."""

import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from functools import cache

import pytest
from dh_grader.grading import misconception as engine
from dh_grader.grading.diagnosis.lists import WrongPosition
from dh_grader.grading.diagnosis.slips_of_the_table import Slip
from dh_grader.grading.misconception import (
    Record,
    Written,
    all_records,
    axes_of_row,
    records_of,
    register,
)
from dh_grader.kinematics import Numbers

from tests.grading.diagnosis.traces import Trace, trace_of
from tests.together import together

# --- Every misconception is used, and its examples are correct

NAMED = [record for record in all_records() if record.codes]
WITHOUT_CODE = [record for record in all_records() if record.function and not record.codes]


def complaint_about(record: Record) -> str:
    if record.example is None or not record.means:
        return f"{record.name}: give it an example, and say what its code means"
    exercise, part, answer, *unit = record.example
    trace = trace_of(exercise, part, answer, *unit)
    # The engine does not give the code of a record without a function.
    explains_example = record in trace.explaining or (
        record.function is None and record.of is not Slip
    )
    if not explains_example:
        return f"{record.name}: {_reason(record, trace)}"
    if not trace.codes.intersection(record.codes):
        return f"{record.name}: its example draws {sorted(trace.codes)}"
    counterexample = trace_of(exercise, part, record.unlike, *unit)
    explains_counterexample = (
        record in counterexample.explaining and counterexample.codes.intersection(record.codes)
    )
    if explains_counterexample or counterexample.is_right:
        return f"{record.name}: its counterexample is right, or drawn by it, too"
    return ""


def _reason(record: Record, trace: Trace) -> str:
    if record not in trace.asked and record.function is not None:
        others = sorted(each.name for each in trace.explaining)
        if not any(each.of is record.of for each in trace.asked):
            return "no engine asks it about its example"
        return f"on its example it is hidden by {', '.join(others)}"
    return f"its example draws {sorted(trace.codes)}, and not by it"


@pytest.mark.long
@together("record", NAMED)
def test_a_record_explains_only_its_example(record: Record) -> None:
    assert complaint_about(record) == ""


@cache
def traces() -> list[Trace]:
    return [trace_of(*record.example) for record in all_records() if record.example]


@pytest.mark.long
@together("record", WITHOUT_CODE)
def test_a_record_without_a_code_is_asked(record: Record) -> None:
    assert any(record in trace.asked for trace in traces()), f"no engine asks {record.name}"


def test_no_two_records_of_a_kind_have_one_rank() -> None:
    ranks = defaultdict(list)
    for kind in {record.of for record in all_records()}:
        for record in records_of(kind):
            ranks[kind.__name__, record.rank].append(record.name)
    assert [names for names in ranks.values() if len(names) > 1] == []


@pytest.mark.long
@pytest.mark.parametrize(
    "first", ["frames.nearest", "diagnosis.slips_of_the_table", "kinds.matrices"]
)
def test_the_order_of_imports_changes_no_record(first: str) -> None:
    program = (
        f"import dh_grader.grading.{first}\n"
        "from dh_grader.grading.misconception import all_records\n"
        "print(*sorted(f'{r.of.__name__} {r.rank} {r.name}' for r in all_records()), sep='\\n')"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    expected = sorted(f"{each.of.__name__} {each.rank} {each.name}" for each in all_records())
    assert done.stdout.splitlines() == expected


# --- the complaint about a wrong record names it


class UnusedCase:
    """A kind of wrong answer that the grader never looks for."""


REVERSED = "[-a1 c1 - a2 c12, -a1 s1 - a2 s12]"
EXCHANGED = "[a1 s1 + a2 s12, a1 c1 + a2 c12]"


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(engine, "_RECORDS", list(all_records()))
    yield
    engine.records_of.cache_clear()


def complaint_about_signs(of: type, rank: int, *signs: int, example: str = REVERSED) -> str:
    def signed(case: WrongPosition) -> Iterator[Written[Numbers]]:
        for sign in signs:
            yield Written(sign * case.expected, "Look at the signs.")
            yield Written(sign * case.expected[::-1], "Look at the signs.")

    record = register(
        of=of,
        rank=rank,
        code="signs",
        name="signed",
        means="signs",
        example=("planar-rr", "position", example),
        unlike=EXCHANGED,
        function=signed,
    )
    return complaint_about(record)


@pytest.mark.usefixtures("known")
def test_a_record_that_no_engine_asks_is_named() -> None:
    assert complaint_about_signs(UnusedCase, 1, -1) == "signed: no engine asks it about its example"


@pytest.mark.usefixtures("known")
def test_a_record_that_another_one_hides_is_named() -> None:
    complaint = complaint_about_signs(WrongPosition, 35, -1)
    assert complaint.startswith("signed: on its example it is hidden by ")
    assert "lists.reversed_position" in complaint


@pytest.mark.usefixtures("known")
def test_a_record_whose_example_draws_something_else_is_named() -> None:
    complaint = complaint_about_signs(WrongPosition, 5, 2)
    assert complaint == "signed: its example draws ['reversed_position'], and not by it"


@pytest.mark.usefixtures("known")
def test_a_record_that_explains_its_counterexample_is_named() -> None:
    complaint = complaint_about_signs(WrongPosition, 5, -1, 1)
    assert complaint == "signed: its counterexample is right, or drawn by it, too"


@pytest.mark.usefixtures("known")
def test_a_correct_record_is_not_named() -> None:
    assert complaint_about_signs(WrongPosition, 5, -1) == ""


# --- Test phrases that several kinds of messages contain


@pytest.mark.parametrize(
    ("label", "axes"),
    [
        ("1", "z0 and z1"),
        ("4", "z3 and z4"),
        ("e", "z6 and the last z axis"),
        ("e2", "the two z axes"),
        ("", "the two z axes"),
    ],
)
def test_the_axes_of_a_row_are_named(label: str, axes: str) -> None:
    assert axes_of_row("z", label, last=6) == axes
