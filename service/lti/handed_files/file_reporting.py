"""Grade handed-in files, one submission after the other."""

import logging
import random
from collections.abc import Callable, Mapping
from datetime import datetime, timedelta
from typing import Final

from sqlalchemy import Engine

from service.access.keys import Secret
from service.attempts.storage.database import in_transaction
from service.catalogue import Exercise
from service.lti.handed_files import queue
from service.lti.handed_files.grading import graded_files, report_on
from service.lti.handed_files.platform_files import PlatformFiles
from service.lti.handed_files.queue import TakenFiles
from service.lti.scores.access_tokens import AccessTokens, available_key
from service.lti.scores.score_problems import RefusedError, ScoreError
from service.lti.scores.sender import utc_now

_log = logging.getLogger(__name__)

# The pause after the first failure, the longest one, and how long files are tried.
_FIRST: Final = timedelta(seconds=5)
_LONGEST: Final = timedelta(hours=4)
_GIVEN_UP: Final = timedelta(days=3)


class FileReporting:
    """Grades handed-in files, and sends the reports to the platform."""

    def __init__(
        self,
        engine: Engine,
        secret: Secret,
        catalogue: Mapping[str, Exercise],
        now: Callable[[], datetime] = utc_now,
        chance: Callable[[], float] = random.random,
    ) -> None:
        # ``now`` returns the time, ``chance`` a random number from 0 to 1 for each pause.
        self._engine, self._catalogue = engine, catalogue
        self.now, self._chance = now, chance
        self._platform = PlatformFiles(
            AccessTokens(now, lambda: available_key(engine, secret, now()))
        )

    def send_next(self) -> bool:
        """Grade the next submission and send its reports; return False if none is due."""
        now = self.now()
        taken = in_transaction(self._engine, lambda it: queue.take(it, now))
        if taken is None:
            return False
        refusal: str | None = None
        try:
            self._report(taken)
        except RefusedError as error:
            refusal = error.stored
            _log.warning("LTI: the report was refused (%s): %s", taken.registration.id, error)
        except ScoreError as error:
            self._later(taken, error)
            return True
        except Exception:  # noqa: BLE001 - other files must go on
            _log.exception("LTI: handed-in files could not be graded")
            self._later(taken, ScoreError("failed"))
            return True
        in_transaction(self._engine, lambda it: queue.note_done(it, taken.number, refusal))
        return True

    def next_due(self) -> datetime | None:
        """Return when the next submission may be graded; None if none waits."""
        with self._engine.connect() as connection:
            return queue.next_due(connection)

    def _report(self, taken: TakenFiles) -> None:
        contents = self._platform.contents_of(taken.registration, taken.files)
        found = graded_files(taken.files, contents, self._catalogue)
        for each in taken.files.assets:
            report = report_on(each, found, self.now())
            self._platform.send_report(taken.registration, taken.files.report_url, report)

    def _later(self, taken: TakenFiles, problem: ScoreError) -> None:
        now, number = self.now(), taken.number
        pause = min(_FIRST * 2 ** min(taken.tries, 20), _LONGEST)
        at = now + pause * (0.5 + 0.5 * self._chance())
        refusal = problem.stored
        if at > taken.received_at + _GIVEN_UP:
            in_transaction(self._engine, lambda it: queue.note_done(it, number, refusal))
        else:
            in_transaction(self._engine, lambda it: queue.note_later(it, number, at, refusal))
        _log.warning("LTI: handed-in files wait (%s): %s", taken.registration.id, problem)
