"""The rules for attempts: dates, the limit, and deductions for lateness and for hints."""

from dataclasses import dataclass
from datetime import datetime

from service.attempts.attempt import hint_points
from service.catalogue.attempts import AttemptsSpec
from service.translations import say, say_count


class AttemptRefusedError(Exception):
    """The attempt is refused. The message is for the learner; ``name`` identifies the reason."""

    def __init__(self, name: str, message: str) -> None:
        self.name = name
        super().__init__(message)


@dataclass(frozen=True, slots=True)
class Ruling:
    """An accepted attempt: its number (1, 2, …), and the factor ``worth`` for its points.

    The factor is 1 for an attempt in time, and less for a late attempt.
    """

    ordinal: int
    is_late: bool
    worth: float


def ruling(rules: AttemptsSpec, counted: int, now: datetime) -> Ruling:
    """Return the number and the factor of a learner's next attempt.

    ``counted`` is the number of attempts that the learner has used. Raises AttemptRefusedError.
    """
    if rules.opens is not None and now < rules.opens:
        opens = say("This exercise opens on {moment}.", moment=_formatted(rules.opens))
        raise AttemptRefusedError("not-open", opens)
    is_late = rules.due is not None and now > rules.due
    end = rules.closes or rules.due
    if end is not None and now > end:
        closed = say("This exercise was closed on {moment}.", moment=_formatted(end))
        raise AttemptRefusedError("closed", closed)
    if rules.limit is not None and counted >= rules.limit:
        used = say_count(
            "No attempt is left: the attempt is used up.",
            "No attempt is left: the {count} attempts are used up.",
            count=rules.limit,
        )
        raise AttemptRefusedError("no-attempts-left", used)
    return Ruling(counted + 1, is_late, rules.late_worth if is_late else 1.0)


def points_after(points: float, max_points: float, hint_price: float, worth: float) -> float:
    """Return the points after deductions for hints and for lateness."""
    return round(max(0.0, points - hint_points(hint_price, max_points)) * worth, 6)


def _formatted(moment: datetime) -> str:
    return moment.strftime("%Y-%m-%d at %H:%M %Z").rstrip()
