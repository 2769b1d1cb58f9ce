"""Choose the variant of an exercise for each learner in an assignment.

A secret of the assignment determines the variants, so that learners cannot guess them.
"""

import json
from collections.abc import Mapping
from typing import Final

from sqlalchemy import Connection, insert, select, update

from service.attempts.storage.tables import assignments, deals
from service.catalogue import Exercise
from service.contract.courses import LearnerVariant
from service.courses.assignments import assignment_row
from service.courses.errors import CourseError
from service.courses.terms import LearnerTerms, terms_of
from service.translations import say
from service.variants.pinned import choices_of, pinned
from service.variants.seeds import seed_of
from service.variants.variant import NoVariantError, hidden_variant

# The most deals that are tried until the seed is another one.
_TRIES: Final = 1000


def assigned(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> tuple[LearnerTerms, Exercise]:
    """Return an assignment's rules for a learner, and the learner's variant of the exercise.

    Raises CourseError.
    """
    terms, own, seed = assigned_seed(connection, course, assignment, learner, exercise)
    return terms, variant_for(own, seed)


def variant_for(exercise: Exercise, seed: str | None) -> Exercise:
    """Return the variant with this seed, or the exercise if ``seed`` is None.

    Raises CourseError.
    """
    # The variant has the id of the plain exercise. The message of the error does not have the seed.
    if seed is None:
        return exercise
    try:
        return hidden_variant(exercise, seed)
    except NoVariantError:
        message = say(
            "Your variant of the exercise {exercise} cannot be made, because its file has a fault. "
            "Ask your tutor for another one.",
            exercise=exercise.plain_id,
        )
        raise CourseError("unusable", message) from None


def assigned_seed(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> tuple[LearnerTerms, Exercise, str | None]:
    """Return three things: the rules of an assignment for a learner, the exercise, and the seed.

    The seed determines the learner's variant. The seed is None if there are no variants. Raises
    CourseError.
    """
    # In the exercise, ``[vary]`` has the choices of the assignment.
    terms = terms_of(connection, course, assignment, learner)
    if exercise.id not in terms.exercises:
        message = say(
            "The exercise {exercise} is not part of the assignment {assignment}.",
            exercise=exercise.id,
            assignment=assignment,
        )
        raise CourseError("not-assigned", message)
    own = pinned(exercise, terms.choices)
    return terms, own, _dealt_seed(connection, terms, learner, own)


def own_variant(
    connection: Connection, terms: LearnerTerms, learner: str, exercise: Exercise
) -> Exercise:
    """Return the learner's variant of an exercise, or the exercise if there is none."""
    # The variant has the id of the plain exercise. The exercise itself is also returned if the
    # variant cannot be made.
    own = pinned(exercise, terms.choices)
    seed = _dealt_seed(connection, terms, learner, own)
    try:
        return exercise if seed is None else variant_for(own, seed)
    except CourseError:
        return exercise


def needs_choices(terms: LearnerTerms, exercise: Exercise) -> bool:
    """True if the rules by which the exercise varies are not stored in the assignment yet."""
    # This is so if an earlier version of the program made the assignment, or if the exercise got
    # variants later.
    if terms.variants is None or exercise.vary is None:
        return False
    return terms.choices is None or exercise.id not in json.loads(terms.choices)


def pin_choices(
    connection: Connection,
    course: str,
    assignment: str,
    catalogue: Mapping[str, Exercise],
    *,
    renew: bool = False,
) -> None:
    """Store the rules by which the exercises of an assignment vary. Raises CourseError.

    Rules that are stored already stay, unless ``renew`` is True.
    """
    # Thus a changed exercise file changes no variant.
    row = assignment_row(connection, course, assignment)
    if row.variants is None:
        return
    exercises = {
        each["exercise"]: catalogue[each["exercise"]]
        for each in json.loads(row.exercises)
        if each["exercise"] in catalogue
    }
    kept = {} if renew or row.choices is None else json.loads(row.choices)
    written = json.dumps({**choices_of(exercises), **kept})
    if written != row.choices:
        mine = assignments.c.number == row.number
        connection.execute(update(assignments).where(mine).values(choices=written))


def _dealt_seed(
    connection: Connection, terms: LearnerTerms, learner: str, exercise: Exercise
) -> str | None:
    if terms.variants is None or exercise.vary is None:
        return None
    number = _number(connection, terms, learner, exercise.id) or 0
    return seed_of(terms.variants, learner, exercise.id, number, exercise.vary.deployed)


def learner_variants(
    connection: Connection,
    course: str,
    assignment: str,
    learner: str,
    catalogue: Mapping[str, Exercise],
) -> list[LearnerVariant]:
    """Return the variants of a learner in an assignment, for tutors. Raises CourseError."""
    terms = terms_of(connection, course, assignment, learner)
    found = []
    for name in terms.exercises:
        if name not in catalogue:
            continue
        exercise = catalogue[name]
        own = pinned(exercise, terms.choices)
        seed = _dealt_seed(connection, terms, learner, own)
        if seed is not None:
            deal = _number(connection, terms, learner, name) or 0
            found.append(_told(exercise, own, seed, deal))
    return found


def _told(exercise: Exercise, own: Exercise, seed: str, deal: int) -> LearnerVariant:
    assert exercise.vary is not None
    assert own.vary is not None
    values = own.vary.written(seed)
    return LearnerVariant(
        exercise=exercise.id,
        variant=f"{exercise.id}~{seed}",
        seed=seed,
        deals=deal + 1,
        values=None if exercise.vary.written(seed) == values else dict(values),
    )


def deal_again(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> LearnerVariant:
    """Give a learner another variant of an exercise. Raises CourseError."""
    terms, own, _ = assigned_seed(connection, course, assignment, learner, exercise)
    if terms.variants is None or own.vary is None:
        reason = say(
            "The assignment {assignment} has no variants of {exercise}.",
            assignment=assignment,
            exercise=exercise.id,
        )
        raise CourseError("unusable", reason)
    dealt = _number(connection, terms, learner, exercise.id)
    before = seed_of(
        terms.variants, learner, exercise.id, dealt or 0, deployed := own.vary.deployed
    )
    for number in range((dealt or 0) + 1, (dealt or 0) + _TRIES):
        seed = seed_of(terms.variants, learner, exercise.id, number, deployed)
        if seed != before:
            break
    else:
        reason = say("There is no other deployed variant of {exercise}.", exercise=exercise.id)
        raise CourseError("unusable", reason)
    mine = {"assignment": terms.number, "learner": learner, "exercise": exercise.id}
    if dealt is None:
        connection.execute(insert(deals).values(mine | {"number": number}))
    else:
        its = [deals.c[name] == value for name, value in mine.items()]
        connection.execute(update(deals).where(*its).values(number=number))
    return _told(exercise, own, seed, number)


def _number(connection: Connection, terms: LearnerTerms, learner: str, exercise: str) -> int | None:
    return connection.scalar(
        select(deals.c.number).where(
            deals.c.assignment == terms.number,
            deals.c.learner == learner,
            deals.c.exercise == exercise,
        )
    )
