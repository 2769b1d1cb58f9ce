"""Test what is read from recorded attempts."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import count

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import ExerciseStatistics
from dh_grader.contract.courses import NewAssignment, NewCourse
from dh_grader.courses.assignments import add_assignment
from dh_grader.courses.roll import add_course
from dh_grader.formats.documents import read_report, rendered
from dh_grader.formats.graded import report_in
from dh_grader.grading import Correction, Feedback, Place, Report, Severity, Submission, grade
from dh_grader.store import (
    AttemptFilter,
    BadCursorError,
    GradesFormat,
    ListedAttempt,
    NewAttempt,
    Outcome,
    recorded_report,
    sentence_in,
    shown_report,
)
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.results import (
    Counting,
    counting_rules,
    earlier_than,
    exercise_statistics,
    graded_attempts,
    history,
    later_than,
    page,
    place_of,
    written,
)
from dh_grader.store.tables import assignments, attempts, earlier_reports, hints, overrides
from dh_grader.translations import ENGLISH, Sentence, say, say_count
from sqlalchemy import ColumnElement, event, insert, select, update

from tests.store.recorded import LAZY, NO_TWIST, NOON, RIGHT, new_attempt, recorded, recorded_all
from tests.together import together
from tests.translations.german import german

# --- The attempt of a learner that counts, and the formats in which attempts are exported


def exported(store: AttemptStore, form: GradesFormat, rule: Counting = "best") -> list[str]:
    with store.engine.connect() as connection:
        graded = graded_attempts(connection, AttemptFilter("scara"), lambda _: rule)
        return b"".join(written(graded, form, "Homework")).decode().splitlines()


@pytest.mark.parametrize(
    ("points", "best", "last"),
    [
        # The points of a learner's attempts, and the attempts that count, from 0.
        ([3, 5, 4], 1, 2),
        # Of two equal attempts the first one counts.
        ([3, 5, 5], 1, 2),
        ([0], 0, 0),
        # Nothing could be read in an attempt that is None.
        ([3, None], 0, 0),
        ([None], None, None),
    ],
)
def test_the_best_or_the_last_attempt_counts(
    store: AttemptStore,
    catalogue: Mapping[str, Exercise],
    points: list[int | None],
    best: int | None,
    last: int | None,
) -> None:
    new = [
        new_attempt(
            catalogue["scara"],
            "ada",
            RIGHT,
            None if each is None else i + 1,
            i,
            points=24 if each is None else each,
        )
        for i, each in enumerate(points)
    ]  # fmt: skip
    recorded_all(store, new)
    expected_by: Mapping[Counting, int | None] = {"best": best, "last": last}
    for rule, expected in expected_by.items():
        counts = [json.loads(each)["counts"] for each in exported(store, GradesFormat.JSONL, rule)]
        assert counts == [i == expected for i in range(len(points))]


def test_attempts_are_sorted_by_exercise_learner_and_time(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    # In the order in which they were recorded.
    given = [
        ("scara", "ada", 2, 1), ("planar-rr", "grace", 1, 1), ("scara", "ada", 1, 0),
        ("scara", "grace", 2, 2), ("planar-rr", "ada", 1, 2), ("scara", "grace", 1, 2),
    ]  # fmt: skip
    table = {"scara": RIGHT, "planar-rr": "a1 0 0 θ1\na2 0 0 θ2"}
    recorded_all(
        store,
        [
            new_attempt(catalogue[exercise], learner, table[exercise], ordinal, hours)
            for exercise, learner, ordinal, hours in given
        ],
    )
    with store.engine.connect() as connection:
        graded = list(graded_attempts(connection, AttemptFilter(), lambda _: "last"))
    # Of two attempts at the same time, the one that was recorded first is first.
    assert [(it.attempt.exercise, it.attempt.learner, it.attempt.ordinal) for it in graded] == [
        ("planar-rr", "ada", 1), ("planar-rr", "grace", 1),
        ("scara", "ada", 1), ("scara", "ada", 2), ("scara", "grace", 2), ("scara", "grace", 1),
    ]  # fmt: skip
    assert [it.counts for it in graded] == [True, True, False, True, True, False]


def test_each_format_has_its_own_lines(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    fixed = {"version": "v", "grader": "g"}
    ada, second, zoe = recorded_all(
        store,
        [
            new_attempt(scara, "ada", RIGHT, 1, 0, points=12.0, max_points=20.0, **fixed),
            new_attempt(scara, "ada", RIGHT, 2, 1, points=18.0, max_points=24.0, **fixed),
            new_attempt(
                scara, "zoë", RIGHT, 1, 2, points=2.5, max_points=16.0, is_late=True, variant="s",
                **fixed,
            ),
        ],
    )  # fmt: skip
    with store.engine.execution_options(writes=True).begin() as connection:
        # A tutor gives the first attempt more points than the second one has.
        first = attempts.c.number == ada.number
        connection.execute(update(attempts).where(first).values(awarded=19.0))
    day = "2026-11-22"
    fields = "exercise learner attempt ordinal at is_late points max_points report_points counts"
    assert exported(store, GradesFormat.CSV) == [
        ",".join([*fields.split(), "version", "grader", "variant"]),
        f"scara,ada,{ada.id},1,{day}T12:00:00+00:00,false,19,20,12,true,v,g,",
        f"scara,ada,{second.id},2,{day}T13:00:00+00:00,false,18,24,18,false,v,g,",
        f"scara,zoë,{zoe.id},1,{day}T14:00:00+00:00,true,2.5,16,2.5,true,v,g,s",
    ]
    told = exported(store, GradesFormat.JSONL)
    assert "zoë" in told[2]
    assert ["variant" in json.loads(each) for each in told] == [False, False, True]
    assert json.loads(told[2]) == {
        "exercise": "scara", "learner": "zoë", "attempt": zoe.id, "ordinal": 1,
        "at": f"{day}T14:00:00+00:00", "is_late": True, "points": 2.5, "max_points": 16.0,
        "report_points": 2.5, "counts": True, "version": "v", "grader": "g", "variant": "s",
    }  # fmt: skip
    # Only the attempts that count are in a gradebook: the most points possible are 20, not 24.
    assert exported(store, GradesFormat.CANVAS) == [
        "Student,ID,SIS User ID,SIS Login ID,Section,Homework",
        "    Points Possible,,,,,20",
        "ada,,,ada,,19",
        "zoë,,,zoë,,2.5",
    ]
    assert exported(store, GradesFormat.MOODLE) == [
        "Identifier,Grade,Maximum Grade,Feedback comments",
        "ada,19,20,",
        "zoë,2.5,16,late",
    ]


@together(("exercise", "expected"), [("scara", "last"), ("planar-rr", "best"), ("no-such", "best")])
def test_the_rule_is_the_exercise_s_or_the_best_attempt(
    catalogue: Mapping[str, Exercise], exercise: str, expected: str
) -> None:
    scara = replace(catalogue["scara"], attempts=AttemptsSpec(counts="last"))
    rule = counting_rules({"scara": scara, "planar-rr": catalogue["planar-rr"]})
    assert rule(exercise) == expected


# --- Listing

EVERY = AttemptFilter()


def all_pages(store: AttemptStore, wanted: AttemptFilter, most: int) -> list[list[ListedAttempt]]:
    pages, cursor = [], None
    with store.engine.connect() as connection:
        for _ in range(99):
            shown, cursor = page(connection, wanted, cursor, most)
            pages.append(shown)
            if cursor is None:
                return pages
    raise AssertionError("the pages do not end")


def test_pages_list_every_attempt_once_while_more_are_recorded(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    # Three attempts at each moment: they are ordered by arrival.
    written = [recorded(store, scara, f"l{i}", NO_TWIST, hours=i // 3).id for i in range(7)]
    assert [[each.id for each in shown] for shown in all_pages(store, EVERY, 3)] == [
        written[6:3:-1],
        written[3:0:-1],
        written[0:1],
    ]
    with store.engine.connect() as connection:
        _, cursor = page(connection, EVERY, None, 3)
    recorded(store, scara, "late", RIGHT, hours=9)
    with store.engine.connect() as connection:
        following, _ = page(connection, EVERY, cursor, 3)
    assert [each.id for each in following] == written[3:0:-1]


def test_a_late_arrival_is_in_the_place_of_its_time(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    hours = {recorded(store, scara, f"l{i}", RIGHT, hours=i).id: i for i in (2, 0, 1)}
    listed = [[hours[each.id] for each in shown] for shown in all_pages(store, EVERY, 1)]
    assert listed == [[2], [1], [0]]


def test_attempts_are_divided_by_a_time_and_a_number(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    hours = (1, 0, 1, 1, 2)
    numbers = [recorded(store, scara, "ada", RIGHT, i, hours=h).number for i, h in enumerate(hours)]
    place = (NOON + timedelta(hours=1), numbers[2])

    def found(chosen: ColumnElement[bool]) -> list[int]:
        rows = select(attempts.c.number).where(chosen).order_by(attempts.c.number)
        with store.engine.connect() as connection:
            return list(connection.scalars(rows))

    assert found(earlier_than(place)) == numbers[:2]
    assert found(later_than(place)) == numbers[3:]


@pytest.mark.long
def test_filters_combine(store: AttemptStore, catalogue: Mapping[str, Exercise]) -> None:
    scara, planar = catalogue["scara"], catalogue["planar-rr"]
    ada = recorded(store, scara, "ada", NO_TWIST)
    second = recorded(store, scara, "ada", RIGHT, 2, hours=1)
    unread = recorded(store, scara, "ada", "?!", None, hours=2)
    other = recorded(store, planar, "grace", "a1 0 0 θ1\na2 0 0 θ2", hours=1)

    def found(wanted: AttemptFilter) -> set[str]:
        return {each.id for shown in all_pages(store, wanted, 2) for each in shown}

    hour = timedelta(hours=1)
    assert found(EVERY) == {ada.id, second.id, unread.id, other.id}
    assert found(AttemptFilter(exercise="scara")) == {ada.id, second.id, unread.id}
    assert found(AttemptFilter(learner="grace")) == {other.id}
    assert found(AttemptFilter(since=NOON + hour, until=NOON + 2 * hour)) == {second.id, other.id}
    assert found(AttemptFilter(counted=False)) == {unread.id}
    assert found(AttemptFilter(learner="ada", counted=True, since=NOON + hour)) == {second.id}


@pytest.mark.parametrize(
    ("wanted", "expected"),
    [
        (AttemptFilter(counted=True), {1, 2, 3}),
        (AttemptFilter(counted=False), {0}),
        (AttemptFilter(exercise="scara~s"), {1}),
        (AttemptFilter(exercise="scara~t"), set()),
        (AttemptFilter(course="robots"), {1, 2}),
        (AttemptFilter(course="robots", assignment="second"), {2}),
        (AttemptFilter(course="others"), {3}),
        (AttemptFilter(course="others", assignment="second"), set()),
        (AttemptFilter(since=NOON + timedelta(hours=1)), {1, 2, 3}),
        (AttemptFilter(until=NOON + timedelta(hours=2)), {0, 1}),
        (AttemptFilter(since=NOON + timedelta(hours=2), until=NOON + timedelta(hours=3)), {2}),
    ],
)
def test_attempts_are_chosen_by_course_variant_time_and_whether_they_count(
    store: AttemptStore,
    catalogue: Mapping[str, Exercise],
    wanted: AttemptFilter,
    expected: set[int],
) -> None:
    scara = catalogue["scara"]
    with store.engine.execution_options(writes=True).begin() as connection:
        for course in ("robots", "others"):
            new = NewCourse(id=course, title="Course", zone="UTC")
            add_course(connection, new, NOON)
        exercises = [{"exercise": "scara", "points": 1}]
        for course, name in (("robots", "first"), ("robots", "second"), ("others", "first")):
            fields = {"id": name, "title": name, "exercises": exercises}
            add_assignment(connection, course, NewAssignment.model_validate(fields), {"scara"})
        rows = connection.execute(select(assignments).order_by(assignments.c.number))
        numbers = [row.number for row in rows]
    new_attempts = [
        new_attempt(scara, "ada", "?!", None),
        new_attempt(scara, "ada", RIGHT, 1, 1, assignment=numbers[0], variant="s"),
        new_attempt(scara, "ada", RIGHT, 2, 2, assignment=numbers[1]),
        new_attempt(scara, "ada", RIGHT, 3, 3, assignment=numbers[2]),
    ]
    written = [each.id for each in recorded_all(store, new_attempts)]
    (found,) = all_pages(store, wanted, 4)
    assert {written.index(each.id) for each in found} == expected


def test_an_invalid_cursor_is_refused(store: AttemptStore) -> None:
    with store.engine.connect() as connection:
        for cursor in (
            "",
            "x",
            "1",
            "1.2.3",
            "-1.2",
            "ffffffffffffffff.1",
            "1." * 9,
            "1_0.0x1",
            "1.٣",
            # A number that is larger than those of a database: 2 to the power of 62.
            "0.4000000000000000",
            "0." + 300 * "f",
            # Times after the year 9999.
            "4000000000000000.0",
            300 * "f" + ".0",
        ):
            with pytest.raises(BadCursorError):
                page(connection, EVERY, cursor, 3)


def test_cursors_at_the_limits_are_places() -> None:
    epoch = datetime(1970, 1, 1, tzinfo=UTC)
    assert place_of("0.0") == (epoch, 0)
    assert place_of("f.3fffffffffffffff") == (epoch + timedelta(microseconds=15), 2**62 - 1)


def test_an_attempt_has_its_answers(store: AttemptStore, catalogue: Mapping[str, Exercise]) -> None:
    written = recorded(store, catalogue["scara"], "ada", LAZY)
    with store.engine.connect() as connection:
        found = history(connection, written.id)
        assert history(connection, "0" * 32) is None
    assert found is not None
    assert (found.submission, found.report) == (written.submission, written.report)
    assert (found.attempt.learner, found.attempt.earned) == ("ada", written.points)


def test_an_attempt_has_its_own_overrides_and_earlier_reports_in_their_order(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    one, other = (recorded(store, catalogue["scara"], learner, LAZY) for learner in ("ada", "x"))
    common = {"version": "v", "grader": "g", "max_points": 24.0}
    with store.engine.execution_options(writes=True).begin() as connection:
        for number, points in ((one.number, 3.0), (other.number, 9.0), (one.number, 1.0)):
            fields = {"attempt": number, "points": points}
            changed = {**fields, "reason": "", "author": "tutor", "at": NOON}
            connection.execute(insert(overrides).values(changed))
            replaced = {**fields, **common, "report": f"{points}", "replaced_at": NOON}
            connection.execute(insert(earlier_reports).values(replaced))
    with store.engine.connect() as connection:
        found = history(connection, one.id)
    assert found is not None
    assert [each.points for each in found.overrides] == [3.0, 1.0]
    assert [each.report for each in found.earlier] == ["3.0", "1.0"]
    assert (found.course, found.hints) == (None, [])


def test_a_list_reads_no_report(store: AttemptStore) -> None:
    # Reports are a hundred times larger than the listed columns.
    statements: list[str] = []
    event.listen(store.engine, "before_cursor_execute", lambda *given: statements.append(given[2]))
    with store.engine.connect() as connection:
        page(connection, AttemptFilter(exercise="scara"), None, 3)
    (statement,) = (each for each in statements if "SELECT" in each)
    assert "report" not in statement


# --- Recorded reports are translated into the language of each reader

GERMAN = german({
    "no answer": "keine Antwort",
    "Exchange {cells}.": "Vertausche {cells}.",
    "{first} and {last}": "{first} und {last}",
    "{count} rows in frame {{0}}": "{count} Zeilen im System {{0}}",
    "Frame {{0}} is given.": "System {{0}} ist gegeben.",
})  # fmt: skip


@pytest.fixture
def report(catalogue: Mapping[str, Exercise]) -> Report:
    graded = grade(catalogue["planar-rr"], Submission({}))
    first = graded.parts[0]
    exchange = say("Exchange {cells}.", cells=say("{first} and {last}", first="a", last="α"))
    texts = (
        exchange,
        say_count("one row", "{count} rows in frame {{0}}", count=2),
        say("Frame {{0}} is given."),
        "c_{12}",
    )
    messages = tuple(Feedback("code", Severity.ERROR, text) for text in texts)
    places = (Place("1", "a", Correction(exchange)), Place("1", "d", Correction("d1", "d_1")))
    placed = replace(messages[0], places=places)
    lost = tuple(replace(each, message=say("no answer")) for each in first.lost)
    return replace(graded, parts=(replace(first, feedback=(placed, *messages), lost=lost),))


def test_english_readers_get_the_report_byte_by_byte(report: Report) -> None:
    recorded = recorded_report(report)
    assert shown_report(recorded, ENGLISH) == rendered(report).decode()
    assert read_report(recorded.encode()) == report
    # Also if this version would write the report in another way.
    assert shown_report(recorded[:-1] + " }", ENGLISH) == rendered(report).decode()[:-1] + " }"


def test_a_report_without_sentences_is_recorded_as_it_is(report: Report) -> None:
    numbers_only = replace(report, parts=())
    recorded = recorded_report(numbers_only)
    assert recorded == rendered(numbers_only).decode()
    assert shown_report(recorded, GERMAN) == recorded


def test_another_reader_gets_another_language(report: Report) -> None:
    shown = shown_report(recorded_report(report), GERMAN)
    assert shown == rendered(report_in(report, GERMAN)).decode()
    part = json.loads(shown)["parts"][0]
    assert [each["message"] for each in part["feedback"]] == [
        "Vertausche a und α.",
        "Vertausche a und α.",
        "2 Zeilen im System {0}",
        "System {0} ist gegeben.",
        "c_{12}",
    ]
    assert part["lost"][0]["message"] == "keine Antwort"


def test_a_sentence_without_values_takes_no_room(report: Report) -> None:
    first = '["Exchange {cells}.",{"cells":["{first} and {last}",{"first":"a","last":"α"}]}]'
    second = '["one row",{"count":2},"{count} rows in frame {{0}}"]'
    third = '["Frame {{0}} is given.",{}]'
    start = f'{{"sentences":[{first},{second},{third}],'
    assert recorded_report(report) == start + rendered(report).decode()[1:]


def test_reports_of_earlier_versions_stay_in_english(report: Report) -> None:
    old = rendered(report).decode()
    assert shown_report(old, GERMAN) == old
    strange = '{"sentences":[],"parts":3}'
    assert shown_report(strange, GERMAN) == '{"parts":3}'


def test_one_sentence_of_a_recorded_report(report: Report) -> None:
    recorded = json.loads(recorded_report(report))
    found = sentence_in(recorded, "Exchange a and α.")
    assert getattr(found, "template", "") == "Exchange {cells}."
    assert type(sentence_in(recorded, "no answer")) is Sentence
    # Translations of the empty text and of braces are none of these texts.
    for text in ("", "c_{12}"):
        found = sentence_in(recorded, text)
        assert (type(found), found) == (str, text)
    assert type(sentence_in({}, "Exchange a and α.")) is str


# --- Statistics

WRONG_LENGTH = NO_TWIST.replace("a2", "a1")


def statistics(store: AttemptStore, **wanted: object) -> ExerciseStatistics:
    with store.engine.connect() as connection:
        return exercise_statistics(connection, AttemptFilter("scara", **wanted))  # type: ignore[arg-type]


def test_a_class_is_counted(store: AttemptStore, catalogue: Mapping[str, Exercise]) -> None:
    scara = catalogue["scara"]
    for learner in ("ada", "grace", "linus"):
        recorded(store, scara, learner, NO_TWIST)
    recorded(store, scara, "grace", RIGHT, 2, hours=24)
    recorded(store, scara, "donald", RIGHT, hours=24)
    recorded(store, scara, "edsger", "?!", None, hours=24)
    recorded(store, scara, "ada", WRONG_LENGTH, 2, hours=24)
    recorded(store, catalogue["planar-rr"], "ada", "0 0 0 θ1")
    told = statistics(store)
    assert (told.attempts, told.learners) == (7, 5)
    table, *others = told.parts
    assert (table.part, table.answered, table.correct) == ("table", 7, 2)
    assert all(part.answered == 0 and part.share is None for part in others)
    second = table.rows[1]
    assert [row.label for row in table.rows] == ["1", "2", "3", "4"]
    assert (second.answered, second.correct) == (6, 2)
    cells = {cell.label: (cell.answered, cell.correct) for cell in second.cells}
    assert cells == {"a": (6, 5), "alpha": (6, 2), "d": (6, 6), "theta": (6, 6)}
    days = {slip.code: slip.by_day for slip in told.misconceptions}
    assert days["half_turn"] == {"2026-11-22": 3, "2026-11-23": 1}
    assert all(slip.attempts == sum(slip.by_day.values()) for slip in told.misconceptions)
    sentences = {slip.code: slip.sentence for slip in told.misconceptions}
    # As docs/sentences.md has it.
    assert sentences["half_turn"] == "α is not right: compare z1 and z2."
    (group,) = told.identical
    assert (group.learners, group.attempts, group.among) == (3, 3, ["ada", "grace", "linus"])
    assert group.wrong == ["table/2/alpha"]


def test_a_span_of_time_is_counted(store: AttemptStore, catalogue: Mapping[str, Exercise]) -> None:
    recorded(store, catalogue["scara"], "ada", NO_TWIST)
    recorded(store, catalogue["scara"], "ada", RIGHT, 2, hours=1)
    told = statistics(store, since=NOON + timedelta(minutes=1))
    assert (told.attempts, told.parts[0].correct) == (1, 1)
    assert (told.misconceptions, told.identical) == ([], [])


def test_the_statistics_of_no_attempts_are_zero(store: AttemptStore) -> None:
    told = statistics(store)
    assert (told.attempts, told.learners, told.parts) == (0, 0, [])


def record_outcome(
    store: AttemptStore, scara: Exercise, ordinals: Sequence[int | None], learner: str = "ada",
    part: str = "table", codes: str = "", cells: str = "", hours: float | None = None,
) -> None:  # fmt: skip
    """Record attempts whose part has these codes and right cells."""
    told = {
        "verdict": "partial",
        "cells": dict.fromkeys(cells.split(), "correct"),
        "codes": codes.split(),
    }
    outcome = Outcome("scara", json.dumps({part: told}))
    recorded_all(
        store,
        [
            (new_attempt(scara, learner, RIGHT, n, hours=hours or n or 0)[0], outcome)
            for n in ordinals
        ],
    )


def test_a_learning_curve_has_twelve_attempts_of_each_learner(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    record_outcome(store, scara, (1, 2, 3), codes="value half_turn")
    record_outcome(store, scara, (4,), codes="value")
    record_outcome(store, scara, range(5, 14))
    # An attempt in which nothing could be read is in no curve.
    record_outcome(store, scara, (None,), codes="value")
    record_outcome(store, scara, (1,), "grace", codes="half_turn")
    record_outcome(store, scara, (2,), "grace", codes="an_a_code")
    # A part that the exercise no longer has.
    record_outcome(store, scara, (3,), "grace", part="axes", codes="value")
    told = statistics(store)
    assert (told.attempts, told.learners) == (17, 2)
    assert told.learners_by_attempt == [2, 2, 2, *[1] * 9]
    found = [(each.part, each.code, each.attempts, each.by_attempt) for each in told.misconceptions]
    assert found == [
        ("table", "value", 5, [1, 1, 1, 1, *[0] * 8]),
        ("table", "half_turn", 4, [2, 1, 1, *[0] * 9]),
        ("axes", "value", 1, [0, 0, 1, *[0] * 9]),
        ("table", "an_a_code", 1, [0, 1, *[0] * 10]),
    ]


def test_the_first_attempt_is_the_one_that_was_made_first(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    # Neither the order of arrival nor the ordinals decide, but the times.
    record_outcome(store, catalogue["scara"], (1,), codes="value", hours=3)
    record_outcome(store, catalogue["scara"], (2,), codes="half_turn", hours=2)
    found = {each.code: each.by_attempt for each in statistics(store).misconceptions}
    assert found == {"value": [0, 1], "half_turn": [1, 0]}


def test_equally_common_misconceptions_are_in_alphabetical_order(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    for i, code in enumerate(("value", "half_turn", "sign", "half_turn"), start=1):
        record_outcome(store, catalogue["scara"], (i,), codes=code)
    found = [each.code for each in statistics(store).misconceptions]
    assert found == ["half_turn", "sign", "value"]


# Ordinals that no other attempt of a learner has.
_ORDINALS = count(1)


def with_wrong_cell(
    scara: Exercise, digest: str, times_of: Mapping[str, int], verdict: str = "incorrect"
) -> list[tuple[NewAttempt, Outcome]]:
    """Return equal attempts, so many of each learner, whose cell 1/a has this verdict."""
    told = {"verdict": "partial", "cells": {"1/a": verdict, "1/d": "correct"}, "codes": []}
    outcome = Outcome("scara", json.dumps({"table": told}))
    return [
        (new_attempt(scara, learner, RIGHT, next(_ORDINALS), answers_digest=digest)[0], outcome)
        for learner, times in times_of.items()
        for _ in range(times)
    ]


def test_equal_wrong_answers_are_in_the_order_of_learners_and_of_attempts(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    groups = {
        "a": {"ada": 1, "grace": 1},
        "b": {"ada": 3, "grace": 1},
        "c": {"linus": 1, "grace": 1, "ada": 1},
        "d": {"ada": 1, "linus": 1},
        # One learner alone has copied nothing.
        "e": {"ada": 5},
    }
    new = [with_wrong_cell(catalogue["scara"], *each) for each in groups.items()]
    new.append(with_wrong_cell(catalogue["scara"], "f", {"ada": 3, "grace": 3}, "correct"))
    recorded_all(store, (each for group in new for each in group))
    found = [(each.learners, each.attempts, each.among) for each in statistics(store).identical]
    assert found == [
        (3, 3, ["ada", "grace", "linus"]),
        (2, 4, ["ada", "grace"]),
        (2, 2, ["ada", "grace"]),
        (2, 2, ["ada", "linus"]),
    ]
    assert {str(each.wrong) for each in statistics(store).identical} == {"['table/1/a']"}


def test_the_statistics_name_the_first_of_very_many(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara, numbers = catalogue["scara"], range(101)
    record_outcome(store, scara, (1,), codes=" ".join(f"code_{i:03}" for i in numbers))
    learners = [f"learner {i:03}" for i in numbers[:51]]
    new = with_wrong_cell(scara, "0", dict.fromkeys(learners, 1))
    for i in numbers[:50]:
        new += with_wrong_cell(scara, f"digest {i}", {"ada": 1, "grace": 1})
    recorded_all(store, new)
    told = statistics(store)
    assert [each.code for each in told.misconceptions] == [f"code_{i:03}" for i in numbers[:100]]
    assert [each.learners for each in told.identical] == [51, *[2] * 49]
    assert told.identical[0].among == learners[:50]


@pytest.mark.parametrize(
    ("with_row", "without", "unread", "is_shown"),
    [(1, 0, 0, True), (1, 1, 0, False), (2, 1, 0, True), (2, 2, 0, False), (1, 0, 2, True)],
)
def test_a_row_is_shown_if_most_tables_have_it(
    store: AttemptStore,
    catalogue: Mapping[str, Exercise],
    with_row: int,
    without: int,
    unread: int,
    is_shown: bool,
) -> None:
    # Tables without cells are not counted.
    numbers = iter(range(1, 10))
    for times, cells in ((with_row, "1/a 5/a"), (without, "1/a"), (unread, "")):
        ordinals = [next(numbers) for _ in range(times)]
        record_outcome(store, catalogue["scara"], ordinals, cells=cells)
    (table,) = statistics(store).parts
    first, fifth = ("1", with_row + without), ("5", with_row)
    shown = [(row.label, row.answered) for row in table.rows]
    assert shown == ([first, fifth] if is_shown else [first])


def test_taken_hints_are_counted(store: AttemptStore, catalogue: Mapping[str, Exercise]) -> None:
    attempt = recorded(store, catalogue["scara"], "ada", NO_TWIST).number
    place = {"attempt": attempt, "part": "table", "code": "half_turn", "row": "2", "at": NOON}
    taken = [{**place, "cell": "alpha", "step": step, "price": 0.1} for step in (1, 2)]
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(insert(hints), [*taken, {**taken[0], "cell": "a"}])
    (told,) = statistics(store).hints
    assert (told.part, told.code, told.taken) == ("table", "half_turn", [2, 1, 0])
