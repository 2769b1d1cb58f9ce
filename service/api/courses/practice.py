"""The check that an assignment lets a learner practise."""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING

from service.access.caller import Caller
from service.api.http.problems import ProblemError, store_down
from service.attempts.errors import StoreDownError

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore


class PracticeGate:
    """Refuses to grade answers that are not recorded, if an assignment of the learner says so."""

    def __init__(self, store: "AttemptStore | None") -> None:
        self._store = store

    async def check(self, caller: Caller, exercise: str) -> None:
        """Raise ProblemError if this learner may not practise the exercise now."""
        refused = await self.refusal(caller, exercise)
        if refused is not None:
            raise refused

    async def refusal(self, caller: Caller, exercise: str) -> ProblemError | None:
        """Return why this learner may not practise the exercise now; None if the learner may."""
        learner = caller.learner
        if self._store is None or learner is None:
            return None
        from service.courses.learner_view import closed_practice

        now = datetime.now(UTC)
        try:
            closed = await self._store.read(
                lambda it: closed_practice(it, learner, caller.course, exercise, now)
            )
        except StoreDownError:
            if caller.course is None:
                # A learner of no course practises also while the database is down.
                return None
            detail = "The database does not say whether this exercise may be practised."
            return store_down(detail)
        if closed is None:
            return None
        return ProblemError(
            HTTPStatus.FORBIDDEN,
            f"This exercise counts in the assignment {closed.title}: hand it in there. "
            "Answers that are not recorded are not graded.",
            "no-practice",
            "This exercise cannot be practised now",
        )
