"""The names of learners as tutors read them."""

from collections import Counter
from collections.abc import Sequence

from service.contract.courses import CourseLearner, MissingLearner


def told_apart(people: Sequence[CourseLearner | MissingLearner]) -> dict[str, str]:
    """Return the name of each learner by id; learners of one name also have e-mail or id."""
    count = Counter(each.name for each in people)
    return {
        each.learner: each.name
        if count[each.name] == 1
        else f"{each.name} ({each.email or each.learner})"
        for each in people
    }
