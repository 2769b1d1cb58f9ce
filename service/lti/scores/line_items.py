"""Line items: the columns of a platform's gradebook, one for each resource link."""

import json
from datetime import datetime
from typing import Final

from sqlalchemy import Connection, select, update

from service.attempts.recording import insert_or_ignore
from service.attempts.storage.lti_tables import line_items, resource_links, scores
from service.attempts.storage.score_queue import queue_scores
from service.attempts.storage.tables import assignments, attempts

AGS: Final = "https://purl.imsglobal.org/spec/lti-ags/scope/"
SEND: Final = f"{AGS}score"
CHANGE: Final = f"{AGS}lineitem"
READ: Final = f"{AGS}lineitem.readonly"


def ensure_line_item(connection: Connection, link: int) -> None:
    """Store the line item (gradebook column) of a resource link, and queue earlier scores."""
    # If the address of the line item is unknown, the sender of the first score looks up the line
    # item, or makes it.
    row = connection.execute(
        select(resource_links).where(resource_links.c.number == link)
    ).one_or_none()
    if row is None or row.assignment is None or not takes_scores(row.scopes):
        return
    if row.lineitem_url is None and row.lineitems_url is None:
        return
    values = {
        "context": row.context,
        "resource_link": row.number,
        "assignment": row.assignment,
        "url": row.lineitem_url,
        "max_points": max_points(connection, row.assignment),
        "is_own": False,
    }
    statement = insert_or_ignore(line_items)[connection.dialect.name]
    if connection.execute(statement.values(values)).rowcount:
        of_assignment = (attempts.c.assignment == row.assignment) & attempts.c.ordinal.is_not(None)
        queue_scores(connection, of_assignment)
    elif row.lineitem_url is not None:
        mine = (line_items.c.resource_link == link) & (line_items.c.assignment == row.assignment)
        is_new = line_items.c.url.is_distinct_from(row.lineitem_url)
        connection.execute(update(line_items).where(mine, is_new).values(url=row.lineitem_url))


def try_refused_again(connection: Connection, learner: str, now: datetime) -> None:
    """Queue a learner's refused scores again."""
    # After a launch, the platform knows the learner.
    mine = (scores.c.learner == learner) & (scores.c.state == "refused")
    values = {"state": "waiting", "next_try_at": now, "version": scores.c.version + 1}
    connection.execute(update(scores).where(mine).values(values))


def takes_scores(scopes: str) -> bool:
    """True if the scopes of a platform allow us to send scores."""
    return SEND in scopes.split()


def max_points(connection: Connection, assignment: int) -> float:
    """Return the sum of the points of an assignment's exercises."""
    mine = assignments.c.number == assignment
    text: str = connection.execute(select(assignments.c.exercises).where(mine)).scalar_one()
    return float(round(sum(each["points"] for each in json.loads(text)), 6))
