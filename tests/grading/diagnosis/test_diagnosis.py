"""Every record: an engine asks it, its example draws it, and it leaves its counterexample alone."""

from collections import defaultdict
from functools import cache

from service.grading.diagnosis.upstream.slip import Slip
from service.grading.misconception import Record, all_records, records_of
from tests.grading.diagnosis.traces import Trace, trace_of
from tests.together import together

NAMED = [record for record in all_records() if record.codes]
PASSING_ON = [record for record in all_records() if record.function and not record.codes]


def what_is_wrong_with(record: Record) -> str:
    """What a test says of a record that does not keep its word; empty if it does."""
    if record.example is None or not record.means:
        return f"{record.name}: give it an example, and say what its code means"
    exercise, part, answer, *unit = record.example
    trace = trace_of(exercise, part, answer, *unit)
    # A record without a function is that of a code that other code than the engine gives.
    is_told = record in trace.told or (record.function is None and record.of is not Slip)
    if not is_told:
        return f"{record.name}: {_reason(record, trace)}"
    if not trace.codes.intersection(record.codes):
        return f"{record.name}: its example draws {sorted(trace.codes)}"
    left_alone = trace_of(exercise, part, record.unlike, *unit)
    is_drawn = record in left_alone.told and left_alone.codes.intersection(record.codes)
    if is_drawn or left_alone.is_right:
        return f"{record.name}: its counterexample is right, or drawn by it, too"
    return ""


def _reason(record: Record, trace: Trace) -> str:
    if record not in trace.asked and record.function is not None:
        others = sorted(each.name for each in trace.told)
        if not any(each.of is record.of for each in trace.asked):
            return "no engine asks it about its example"
        return f"on its example it is hidden by {', '.join(others)}"
    return f"its example draws {sorted(trace.codes)}, and not by it"


@together("record", NAMED)
def test_a_record_keeps_its_word(record: Record) -> None:
    assert what_is_wrong_with(record) == ""


@cache
def traces() -> list[Trace]:
    """The traces of all examples."""
    return [trace_of(*record.example) for record in all_records() if record.example]


@together("record", PASSING_ON)
def test_what_passes_a_finding_on_is_asked(record: Record) -> None:
    assert any(record in trace.asked for trace in traces()), f"no engine asks {record.name}"


def test_no_two_records_of_a_kind_have_one_rank() -> None:
    ranks = defaultdict(list)
    for kind in {record.of for record in all_records()}:
        for record in records_of(kind):
            ranks[kind.__name__, record.rank].append(record.name)
    assert [names for names in ranks.values() if len(names) > 1] == []
