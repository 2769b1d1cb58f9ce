from collections.abc import Mapping
from datetime import UTC, datetime, timedelta

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.contract.courses import NewAssignment, NewCourse
from dh_grader.courses.assignments import add_assignment
from dh_grader.courses.roll import add_course
from dh_grader.store import AttemptFilter, BadCursorError, ListedAttempt
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.results import earlier_than, history, later_than, page, place_of
from dh_grader.store.tables import assignments, attempts, earlier_reports, overrides
from sqlalchemy import ColumnElement, event, insert, select

from tests.attempts.recorded import LAZY, NO_TWIST, NOON, RIGHT, new_attempt, recorded, recorded_all

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
