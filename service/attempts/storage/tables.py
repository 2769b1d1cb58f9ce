"""The tables of the database after the newest migration."""

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    BigInteger,
    Boolean,
    Column,
    DateTime,
    Dialect,
    Float,
    ForeignKey,
    Index,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
    text,
)
from sqlalchemy.types import TypeDecorator


class UtcTime(TypeDecorator[datetime]):
    """A column of times in UTC, also in databases without time zones (SQLite)."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, _: Dialect) -> datetime | None:
        """Convert to UTC. Raises ValueError if the time has no zone."""
        if value is None:
            return None
        if value.tzinfo is None:
            raise ValueError("a moment needs its time zone")
        return value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, _: Dialect) -> datetime | None:
        """Add the zone UTC if the database has not stored it."""
        return value.replace(tzinfo=UTC) if value is not None and value.tzinfo is None else value


# In SQLite only a plain INTEGER increments automatically.
RowNumber = BigInteger().with_variant(Integer, "sqlite")

metadata = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s",
        "pk": "pk_%(table_name)s",
    }
)

# The verdicts and codes of a report. Many attempts share an outcome, so that the statistics of a
# class count a few thousand outcomes instead of every cell of every attempt.
outcomes = Table(
    "outcomes",
    metadata,
    Column("id", RowNumber, primary_key=True),
    Column("exercise", String(100), nullable=False),
    Column("digest", String(64), nullable=False),
    Column("content", Text, nullable=False),
    UniqueConstraint("exercise", "digest"),
)

# ``id`` is chosen by the tutor; ``zone`` is the IANA name of the time zone.
courses = Table(
    "courses",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("title", String(200), nullable=False),
    Column("zone", String(64), nullable=False),
    Column("created_at", UtcTime, nullable=False),
)

# ``learner`` is the name in attempts. Tutors see ``name`` and ``email``; attempts have neither.
course_learners = Table(
    "course_learners",
    metadata,
    Column("course", String(64), ForeignKey(courses.c.id), primary_key=True),
    Column("learner", String(200), primary_key=True, index=True),
    Column("name", String(200), nullable=False),
    Column("email", String(254)),
    Column("family_name", String(200)),
)

# ``exercises`` is a JSON list of exercises with their points; ``feedback`` a list of levels, one
# for each attempt, or NULL for that of each exercise. ``variants`` is the secret from which the
# seeds of the learners follow, or NULL if all learners get the same exercise. ``choices`` has the
# table ``[vary]`` of each exercise, as JSON, as it was when the assignment got its variants.
# ``hint_prices`` is a JSON list, or NULL for those of each exercise.
assignments = Table(
    "assignments",
    metadata,
    Column("number", RowNumber, primary_key=True),
    Column("course", String(64), ForeignKey(courses.c.id), nullable=False),
    Column("id", String(64), nullable=False),
    Column("title", String(200), nullable=False),
    Column("exercises", Text, nullable=False),
    Column("opens", UtcTime),
    Column("due", UtcTime),
    Column("closes", UtcTime),
    Column("max_attempts", Integer),
    Column("late_worth", Float, nullable=False),
    Column("feedback", Text),
    Column("practice", String(10), nullable=False),
    Column("solution", String(10), nullable=False),
    Column("variants", String(64)),
    Column("choices", Text),
    Column("hint_prices", Text),
    UniqueConstraint("course", "id"),
)

# How often a learner got another variant of an exercise; there is no row for the first variant.
deals = Table(
    "deals",
    metadata,
    Column("assignment", RowNumber, ForeignKey(assignments.c.number), primary_key=True),
    Column("learner", String(200), primary_key=True, index=True),
    Column("exercise", String(100), primary_key=True),
    Column("number", Integer, nullable=False),
)

# Other dates or another limit of one learner; NULL means that of the assignment.
extensions = Table(
    "extensions",
    metadata,
    Column("assignment", RowNumber, ForeignKey(assignments.c.number), primary_key=True),
    Column("learner", String(200), primary_key=True, index=True),
    Column("due", UtcTime),
    Column("closes", UtcTime),
    Column("max_attempts", Integer),
)

# The condition of an index of uncounted attempts, in which nothing could be read. They are few.
_UNCOUNTED: Any = dict.fromkeys(("sqlite_where", "postgresql_where"), text("ordinal IS NULL"))
# The condition of an index of attempts in assignments.
_ASSIGNED: Any = dict.fromkeys(("sqlite_where", "postgresql_where"), text("assignment IS NOT NULL"))

# ``number`` is the order of arrival. ``ordinal`` counts the learner's counted attempts at the
# exercise, in all assignments and none; it is unique, so that two requests at once cannot both take
# the last allowed attempt. ``assignment`` is NULL if the attempt belongs to none. ``variant`` is a
# seed, or NULL for the exercise itself.
# ``awarded`` are points of a tutor instead of the report's. ``hint_price`` is what the hints before
# the attempt cost, as a share of its points. The indexes cover all columns by which
# lists are filtered and statistics counted, because the rows with their reports are far larger.
attempts = Table(
    "attempts",
    metadata,
    Column("number", RowNumber, primary_key=True),
    Column("id", String(32), nullable=False, unique=True),
    Column("exercise", String(100), nullable=False),
    Column("learner", String(200), nullable=False),
    Column("ordinal", Integer),
    Column("at", UtcTime, nullable=False),
    Column("is_late", Boolean, nullable=False),
    Column("worth", Float, nullable=False),
    Column("submission", Text, nullable=False),
    Column("answers_digest", String(64), nullable=False),
    Column("report", Text, nullable=False),
    Column("version", String(64), nullable=False),
    Column("grader", String(32), nullable=False),
    Column("points", Float, nullable=False),
    Column("max_points", Float, nullable=False),
    Column("outcome", RowNumber, ForeignKey(outcomes.c.id), nullable=False),
    Column("owner", String(32), nullable=False),
    Column("idempotency_key", String(255)),
    Column("request_digest", String(64), nullable=False),
    UniqueConstraint("exercise", "learner", "ordinal"),
    UniqueConstraint("owner", "idempotency_key"),
    Column("awarded", Float),
    Column("assignment", RowNumber, ForeignKey(assignments.c.number)),
    Column("variant", String(20)),
    Column("hint_price", Float, nullable=False, server_default="0"),
    Index("ix_attempts_assigned", "exercise", "learner", "assignment", "ordinal", **_ASSIGNED),
    # It has all columns of a gradebook.
    Index(
        "ix_attempts_assignment",
        "assignment",
        "learner",
        "exercise",
        "ordinal",
        "points",
        "max_points",
        "awarded",
        "is_late",
        **_ASSIGNED,
    ),
    Index("ix_attempts_uncounted", "at", "number", **_UNCOUNTED),
    Index("ix_attempts_exercise_uncounted", "exercise", "at", "number", **_UNCOUNTED),
    Index("ix_attempts_at", "at", "number", "ordinal"),
    Index("ix_attempts_exercise", "exercise", "at", "number", "ordinal"),
    Index("ix_attempts_learner", "learner", "at", "number", "ordinal"),
    Index("ix_attempts_outcome", "exercise", "outcome", "answers_digest", "learner", "at"),
)

# The steps of hints that learners took for messages on an attempt. ``row`` and ``cell`` are empty
# if the message has none. ``price`` is a share of the points of the exercise.
hints = Table(
    "hints",
    metadata,
    Column("id", RowNumber, primary_key=True),
    Column("attempt", RowNumber, ForeignKey(attempts.c.number), nullable=False),
    Column("part", String(40), nullable=False),
    Column("code", String(40), nullable=False),
    Column("row", String(40), nullable=False),
    Column("cell", String(40), nullable=False),
    Column("step", Integer, nullable=False),
    Column("price", Float, nullable=False),
    Column("at", UtcTime, nullable=False),
    UniqueConstraint("attempt", "part", "row", "cell", "step"),
)

# Points awarded by a tutor instead of a report's, or NULL to withdraw them; the newest row counts.
overrides = Table(
    "overrides",
    metadata,
    Column("id", RowNumber, primary_key=True),
    Column("attempt", RowNumber, ForeignKey(attempts.c.number), nullable=False, index=True),
    Column("points", Float),
    Column("reason", Text, nullable=False),
    Column("author", String(200), nullable=False),
    Column("at", UtcTime, nullable=False),
)

# The reports that a regrade has replaced.
earlier_reports = Table(
    "earlier_reports",
    metadata,
    Column("id", RowNumber, primary_key=True),
    Column("attempt", RowNumber, ForeignKey(attempts.c.number), nullable=False, index=True),
    Column("replaced_at", UtcTime, nullable=False),
    Column("report", Text, nullable=False),
    Column("version", String(64), nullable=False),
    Column("grader", String(32), nullable=False),
    Column("points", Float, nullable=False),
    Column("max_points", Float, nullable=False),
)

# The attempts that wait to be regraded. A worker locks the rows that it takes.
regrade_queue = Table(
    "regrade_queue",
    metadata,
    Column("attempt", RowNumber, ForeignKey(attempts.c.number), primary_key=True),
    Column("exercise", String(100), nullable=False),
    Index(None, "exercise", "attempt"),
)

# ``digest`` is a keyed hash of the key's text; ``scopes`` are words separated by spaces,
# ``exercises`` a JSON list, or NULL for all. ``course`` and ``learner`` restrict the key; that of a
# personal link has a learner.
keys = Table(
    "keys",
    metadata,
    Column("id", String(8), primary_key=True),
    Column("digest", String(64), nullable=False, unique=True),
    Column("name", String(200), nullable=False),
    Column("scopes", String(100), nullable=False),
    Column("exercises", Text),
    Column("created_at", UtcTime, nullable=False),
    Column("expires_at", UtcTime, nullable=False),
    Column("revoked_at", UtcTime),
    Column("last_used_at", UtcTime),
    Column("course", String(64)),
    Column("learner", String(200)),
    Index(None, "course", "learner"),
)

# The keyed hash of a constant with the service's secret, in one row, since the first key was added.
# A database of an earlier version has keys, but no row until the next key is added.
key_secrets = Table(
    "key_secrets",
    metadata,
    Column("id", Integer, primary_key=True, autoincrement=False),
    Column("digest", String(64), nullable=False),
)
