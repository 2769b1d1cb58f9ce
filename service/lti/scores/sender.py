"""Send queued scores to platforms, one after the other."""

# Several processes may send.

import logging
import random
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Final

from sqlalchemy import Engine

from service.access.keys import Secret
from service.attempts.storage.database import in_transaction
from service.lti.scores import outbox
from service.lti.scores.access_tokens import AccessTokens, available_key
from service.lti.scores.grade_services import GradeServices, NotThereError
from service.lti.scores.learner_score import score_message
from service.lti.scores.outbox import TakenScore
from service.lti.scores.score_problems import (
    LaterError,
    RefusedError,
    ScoreError,
    ThisLaterError,
)

_log = logging.getLogger(__name__)

# The pause after the first failure, and the longest one. Each failure doubles it.
_FIRST: Final = timedelta(seconds=5)
_LONGEST: Final = timedelta(hours=4)
_MOST_ASKED: Final = timedelta(hours=24)
# How long others wait for the process that makes a line item.
_LINE_ITEM: Final = timedelta(seconds=3)


def utc_now() -> datetime:
    """Return the current time in UTC."""
    return datetime.now(UTC)


@dataclass(slots=True)
class _Pause:
    until: datetime
    failures: int


class ScoreSender:
    """Sends scores. After a failure, a platform gets no scores for a while."""

    def __init__(
        self,
        engine: Engine,
        secret: Secret,
        now: Callable[[], datetime] = utc_now,
        chance: Callable[[], float] = random.random,
    ) -> None:
        # ``now`` returns the time, ``chance`` a random number from 0 to 1 for each pause.
        self._engine = engine
        self.now, self._chance = now, chance
        self._name = secrets.token_hex(8)
        self._pauses: dict[str, _Pause] = {}
        self._services = GradeServices(
            AccessTokens(now, lambda: available_key(engine, secret, now()))
        )

    def send_next(self) -> bool:
        """Send the next score that is due; return False if none is due."""
        now = self.now()
        resting = [name for name, pause in self._pauses.items() if now < pause.until]
        taken = in_transaction(self._engine, lambda it: outbox.take(it, self._name, now, resting))
        if taken is None:
            return False
        try:
            self._send(taken)
        except RefusedError as error:
            self._pauses.pop(taken.registration.id, None)
            problem = error
            in_transaction(
                self._engine, lambda it: outbox.note_refused(it, taken, self._name, problem)
            )
            _log.warning("LTI: the score was refused (%s): %s", taken.registration.id, error)
        except LaterError as error:
            self._rest(taken, error)
        except ThisLaterError as error:
            self._later(taken, self._doubled(taken.tries), error)
        except Exception:  # noqa: BLE001 - other scores must go on
            _log.exception("LTI: a score could not be sent")
            self._later(taken, self._doubled(taken.tries), ScoreError("failed"))
        return True

    def next_due(self) -> datetime | None:
        """Return when the next score may be sent; None if no score waits."""
        with self._engine.connect() as connection:
            due = outbox.next_due(connection)
        now = self.now()
        if due is None or due > now:
            return due
        resting = [pause.until for pause in self._pauses.values() if pause.until > now]
        return min(resting, default=due)

    def _send(self, taken: TakenScore) -> None:
        url = taken.url or self._line_item(taken)
        if url is None:
            return
        message = score_message(taken.score, taken.sub, taken.stamp, taken.registration.launch_url)
        try:
            self._services.send_score(taken.registration, url, message)
        except NotThereError:
            # The line item may have a new address.
            found = self._services.found_line_item(taken.registration, taken.column)
            if found is None and taken.column.lineitems_url is not None:
                raise RefusedError("no-line-item") from None
            if found in (None, url):
                raise
            now = self.now()
            in_transaction(
                self._engine, lambda it: outbox.note_line_item(it, taken.line_item, found, now)
            )
            self._services.send_score(taken.registration, found, message)
        self._pauses.pop(taken.registration.id, None)
        now = self.now()
        in_transaction(self._engine, lambda it: outbox.note_sent(it, taken, self._name, now))

    def _line_item(self, taken: TakenScore) -> str | None:
        # If another process is making the line item, the score is delayed.
        now, number = self.now(), taken.line_item
        if not in_transaction(self._engine, lambda it: outbox.lease_line_item(it, number, now)):
            self._later(taken, now + _LINE_ITEM, None)
            return None
        url, is_made = None, False
        try:
            url, is_made = self._services.line_item(taken.registration, taken.column)
        finally:
            found, now = url, self.now()
            in_transaction(
                self._engine,
                lambda it: outbox.note_line_item(it, number, found, now, is_made=is_made),
            )
        return url

    def _rest(self, taken: TakenScore, error: LaterError) -> None:
        # The pause is at least as long as the platform asks, up to a limit.
        name, now = taken.registration.id, self.now()
        before = self._pauses.get(name)
        failures = 0 if before is None else before.failures
        until = self._doubled(failures)
        if error.seconds is not None:
            asked = min(timedelta(seconds=error.seconds), _MOST_ASKED)
            until = max(now + asked, until if failures else now)
        self._pauses[name] = _Pause(until, failures + 1)
        self._later(taken, until, error)
        _log.warning("LTI: %s gets no scores until %s: %s", name, until.isoformat(), error)

    def _later(self, taken: TakenScore, at: datetime, problem: ScoreError | None) -> None:
        in_transaction(
            self._engine, lambda it: outbox.note_later(it, taken, self._name, at, problem)
        )

    def _doubled(self, failures: int) -> datetime:
        # Each failure doubles the pause, which is partly random.
        pause = min(_FIRST * 2 ** min(failures, 20), _LONGEST)
        end: datetime = self.now() + pause * (0.5 + 0.5 * self._chance())
        return end
