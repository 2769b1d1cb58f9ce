"""Regrading in steps, each short enough for one request."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from service.attempts.errors import BadCursorError, StoreDownError
from service.attempts.regrades.outdated import BATCH, RegradedAttempt, Regrading
from service.attempts.results.listing import TimePlace, cursor_of, place_of
from service.attempts.storage.database import in_transaction, reason
from service.regex import regex

# A step ends after the batch with which it reaches this time or this number of attempts.
_SECONDS: Final = 1.0
_MOST: Final = 20 * BATCH
# The batch size of a preview: fifty costly answers would take seconds.
_PREVIEW_BATCH: Final = 10
# The place where a step ended, and the number of attempts that are left after it.
_CURSOR: Final = regex(r"(?P<place>[0-9a-f]{1,20}\.[0-9a-f]{1,20})?:(?P<left>[0-9a-f]{1,15})")


@dataclass(frozen=True, slots=True)
class RegradeStep:
    """The attempts of one step, the number of attempts left, and the cursor of the next step."""

    regraded: Sequence[RegradedAttempt]
    left: int
    following: str | None


def preview_step(engine: Engine, regrading: Regrading, cursor: str | None) -> RegradeStep:
    """Regrade some outdated attempts without writing. Raises BadCursorError, StoreDownError."""
    place, left = (None, 0) if cursor is None else _read(cursor)
    done: list[RegradedAttempt] = []
    end = time.monotonic() + _SECONDS
    try:
        with engine.connect() as connection:
            if cursor is None:
                left = regrading.outdated_count(connection)
            found = regrading.outdated_after(connection, place, _PREVIEW_BATCH)
            while found:
                done += regrading.preview(connection, [number for _, number in found])
                place = found[-1]
                if time.monotonic() >= end or len(done) >= _MOST:
                    break
                found = regrading.outdated_after(connection, place, _PREVIEW_BATCH)
    except SQLAlchemyError as error:
        raise StoreDownError(reason(error)) from error
    # In the meantime, attempts may have been recorded or regraded.
    left = max(left - len(done), 0)
    following = f"{cursor_of(place)}:{left:x}" if found and place is not None else None
    return RegradeStep(done, left, following)


def apply_step(engine: Engine, regrading: Regrading, cursor: str | None) -> RegradeStep:
    """Regrade some outdated attempts; several processes may do so at once.

    The first step has no cursor. Raises BadCursorError, StoreDownError.
    """
    if cursor is not None:
        _read(cursor)
    done: list[RegradedAttempt] = []
    end = time.monotonic() + _SECONDS
    try:
        if cursor is None:
            in_transaction(engine, regrading.enqueue)
        while batch := regrading.next_batch(engine):
            done += batch
            if time.monotonic() >= end or len(done) >= _MOST:
                break
        with engine.connect() as connection:
            left = regrading.waiting(connection)
    except SQLAlchemyError as error:
        raise StoreDownError(reason(error)) from error
    return RegradeStep(done, left, f":{left:x}" if left else None)


def _read(cursor: str) -> tuple[TimePlace | None, int]:
    found = _CURSOR.fullmatch(cursor)
    if found is None:
        raise BadCursorError(cursor)
    place = found["place"]
    return None if place is None else place_of(place), int(found["left"], 16)
