"""Compute a learner's score in an assignment, and make the message that sends it to a platform."""

import json
from datetime import datetime
from typing import Any, Final, NamedTuple

from sqlalchemy import Connection, or_, select

from service.attempts.storage.tables import assignments, attempts
from service.courses.results.gradebook import SHARE

_CANVAS: Final = "https://canvas.instructure.com/lti/submission"


class LearnerScore(NamedTuple):
    """A learner's points in an assignment, or None if no attempt counts.

    ``submitted_at`` is the time of the last attempt that counts.
    """

    points: float | None
    max_points: float
    submitted_at: datetime | None


def learner_score(connection: Connection, assignment: int, learner: str) -> LearnerScore:
    """Return the score of a learner in an assignment."""
    mine = assignments.c.number == assignment
    text = connection.execute(select(assignments.c.exercises).where(mine)).scalar_one()
    points = {each["exercise"]: each["points"] for each in json.loads(text)}
    of = attempts.c
    counted = (
        select(of.exercise, SHARE.label("share"), of.at)
        .where(
            of.assignment == assignment,
            of.learner == learner,
            or_(of.ordinal.is_not(None), of.awarded.is_not(None)),
        )
        .order_by(of.number)
    )
    best: dict[str, tuple[float, datetime]] = {}
    for exercise, share, at in connection.execute(counted):
        if exercise not in points:
            continue
        # Of equal attempts, the first one counts: a later one does not make the score late.
        if exercise not in best or (share or 0.0) > best[exercise][0]:
            best[exercise] = (share or 0.0, at)
    most = float(round(sum(points.values()), 6))
    if not best:
        return LearnerScore(None, most, None)
    earned = sum(round(share * points[name], 6) for name, (share, _) in best.items())
    return LearnerScore(float(round(earned, 6)), most, max(at for _, at in best.values()))


def score_message(score: LearnerScore, sub: str, stamp: datetime, address: str) -> dict[str, Any]:
    """Return the message that sends a score to a platform.

    A score without points deletes the platform's score.
    """
    # ``address`` launches the assignment. Some fields of the message are only for Canvas.
    message: dict[str, Any] = {"userId": sub, "timestamp": _written(stamp)}
    if score.points is None:
        return message | {"activityProgress": "Initialized", "gradingProgress": "NotReady"}
    # Without data of a submission, Canvas shows 0 points as "needs grading".
    submission = {
        "new_submission": False,
        "submission_type": "basic_lti_launch",
        "submission_data": address,
    }
    message |= {
        "scoreGiven": score.points,
        "scoreMaximum": score.max_points,
        "activityProgress": "Completed",
        "gradingProgress": "FullyGraded",
    }
    if score.submitted_at is not None:
        message["submission"] = {"submittedAt": _written(score.submitted_at)}
        submission["submitted_at"] = _written(score.submitted_at)
    return message | {_CANVAS: submission}


def _written(moment: datetime) -> str:
    return moment.isoformat(timespec="milliseconds").replace("+00:00", "Z")
