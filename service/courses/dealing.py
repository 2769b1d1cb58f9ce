"""Which variant of an exercise a learner has in an assignment. Learners never see the seed.

It follows from a secret of the assignment, so that the learner has the same variant each time.
"""

from collections.abc import Mapping
from typing import Final

from sqlalchemy import Connection, insert, select, update

from service.attempts.storage.tables import deals
from service.catalogue import Exercise
from service.contract.courses import LearnerVariant
from service.courses.errors import CourseError
from service.courses.terms import LearnerTerms, terms_of
from service.variants.seeds import seed_of
from service.variants.variant import hidden_variant

# The most deals that are tried until the seed is another one.
_TRIES: Final = 1000


def assigned(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> tuple[LearnerTerms, Exercise]:
    """Return the terms of an assignment, and the exercise or the learner's variant of it.

    Raises CourseError.
    """
    terms, seed = assigned_seed(connection, course, assignment, learner, exercise)
    return terms, exercise if seed is None else hidden_variant(exercise, seed)


def assigned_seed(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> tuple[LearnerTerms, str | None]:
    """Return the terms of an assignment, and the seed of the learner's variant, if there is one.

    Raises CourseError.
    """
    terms = terms_of(connection, course, assignment, learner)
    if exercise.id not in terms.exercises:
        message = f"The exercise {exercise.id} is not part of the assignment {assignment}."
        raise CourseError("not-assigned", message)
    return terms, dealt_seed(connection, terms, learner, exercise)


def own_variant(
    connection: Connection, terms: LearnerTerms, learner: str, exercise: Exercise
) -> Exercise:
    """Return the learner's variant of an exercise under its plain id, or the exercise itself."""
    seed = dealt_seed(connection, terms, learner, exercise)
    return exercise if seed is None else hidden_variant(exercise, seed)


def dealt_seed(
    connection: Connection, terms: LearnerTerms, learner: str, exercise: Exercise
) -> str | None:
    """Return the seed of the learner's variant; None if there are no variants."""
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
        exercise = catalogue.get(name)
        seed = exercise and dealt_seed(connection, terms, learner, exercise)
        if seed:
            deal = _number(connection, terms, learner, name) or 0
            variant = f"{name}~{seed}"
            found.append(LearnerVariant(exercise=name, variant=variant, seed=seed, deals=deal + 1))
    return found


def deal_again(
    connection: Connection, course: str, assignment: str, learner: str, exercise: Exercise
) -> LearnerVariant:
    """Give a learner another variant of an exercise. Raises CourseError."""
    terms, _ = assigned(connection, course, assignment, learner, exercise)
    if terms.variants is None or exercise.vary is None:
        reason = f"The assignment {assignment} has no variants of {exercise.id}."
        raise CourseError("unusable", reason)
    dealt = _number(connection, terms, learner, exercise.id)
    before = seed_of(
        terms.variants, learner, exercise.id, dealt or 0, deployed := exercise.vary.deployed
    )
    for number in range((dealt or 0) + 1, (dealt or 0) + _TRIES):
        seed = seed_of(terms.variants, learner, exercise.id, number, deployed)
        if seed != before:
            break
    else:
        raise CourseError("unusable", f"There is no other deployed variant of {exercise.id}.")
    mine = {"assignment": terms.number, "learner": learner, "exercise": exercise.id}
    if dealt is None:
        connection.execute(insert(deals).values(mine | {"number": number}))
    else:
        own = [deals.c[name] == value for name, value in mine.items()]
        connection.execute(update(deals).where(*own).values(number=number))
    variant = f"{exercise.id}~{seed}"
    return LearnerVariant(exercise=exercise.id, variant=variant, seed=seed, deals=number + 1)


def _number(connection: Connection, terms: LearnerTerms, learner: str, exercise: str) -> int | None:
    return connection.scalar(
        select(deals.c.number).where(
            deals.c.assignment == terms.number,
            deals.c.learner == learner,
            deals.c.exercise == exercise,
        )
    )
