"""The names of learners in lists for tutors, and their alphabetical order."""

import unicodedata
from collections import Counter
from collections.abc import Sequence
from typing import Any

from service.contract.courses import CourseLearner, MissingLearner


def told_apart(people: Sequence[CourseLearner | MissingLearner]) -> dict[str, str]:
    """Return different names by id: equal names get the e-mail address or id added."""
    count = Counter(each.name for each in people)
    return {
        each.learner: each.name
        if count[each.name] == 1
        else f"{each.name} ({each.email or each.learner})"
        for each in people
    }


def place_of(learner: Any) -> tuple[str, str, str]:
    """Return the key for sorting learners: by family name, then name, then id."""
    # A learner without a family name is sorted by the name. Capitals and accents do not matter.
    name = _plain(learner.name)
    return _plain(learner.family_name) if learner.family_name else name, name, learner.learner


def _plain(text: str) -> str:
    letters = unicodedata.normalize("NFKD", text.casefold())
    return "".join(each for each in letters if not unicodedata.combining(each))
