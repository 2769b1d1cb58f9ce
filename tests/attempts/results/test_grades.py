"""The attempt of a learner that counts, and the formats in which attempts are exported."""

import json
from collections.abc import Mapping
from dataclasses import replace

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.store import AttemptFilter, GradesFormat
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.results import Counting, counting_rules, graded_attempts, written
from dh_grader.store.tables import attempts
from sqlalchemy import update

from tests.attempts.recorded import RIGHT, new_attempt, recorded_all
from tests.together import together


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
