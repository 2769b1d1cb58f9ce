"""The tables of the database after the newest migration.

Older tables are made and changed by ``migrations``; statements are in the other files.
"""

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

# --- The types and names of columns


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


# --- The tables of attempts, courses and keys


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


# --- The tables of LTI: platforms, launches, linked courses, assignments and learners, and scores


# The longest texts that platforms choose. The standard allows 255 characters of ASCII.
NAME = String(255)
ADDRESS = String(1000)

# ``address`` is that of this service as the platform's users know it; ``audience`` that of access
# tokens, NULL for the token address. ``any_deployment`` accepts deployments that are not listed.
# ``is_development`` allows plain HTTP on this machine, and nothing else. ``refusal`` is the reason
# of the last refused launch.
registrations = Table(
    "lti_registrations",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("name", String(200), nullable=False),
    Column("issuer", ADDRESS, nullable=False),
    Column("client_id", NAME, nullable=False),
    Column("auth_url", ADDRESS, nullable=False),
    Column("jwks_url", ADDRESS, nullable=False),
    Column("token_url", ADDRESS),
    Column("audience", ADDRESS),
    Column("address", ADDRESS, nullable=False),
    Column("zone", String(64), nullable=False),
    Column("any_deployment", Boolean, nullable=False),
    Column("is_development", Boolean, nullable=False),
    Column("created_at", UtcTime, nullable=False),
    Column("launched_at", UtcTime),
    Column("refused_at", UtcTime),
    Column("refusal", String(64)),
    UniqueConstraint("issuer", "client_id"),
)
_REGISTRATION = registrations.c.id

deployments = Table(
    "lti_deployments",
    metadata,
    Column("registration", String(64), ForeignKey(_REGISTRATION), primary_key=True),
    Column("deployment", NAME, primary_key=True),
    Column("created_at", UtcTime, nullable=False),
)

# The keys with which this service signs. ``private_key`` is encrypted with the service's secret.
own_keys = Table(
    "lti_own_keys",
    metadata,
    Column("id", String(32), primary_key=True),
    Column("private_key", Text, nullable=False),
    Column("public_key", Text, nullable=False),
    Column("created_at", UtcTime, nullable=False),
    Column("signs_from", UtcTime, nullable=False),
)

# Begun logins. Of the state, the nonce and the secret of the browser, only digests are stored.
# ``storage_target`` is the frame of the platform's storage, ``parameters`` the login as JSON.
launches = Table(
    "lti_launches",
    metadata,
    Column("state", String(64), primary_key=True),
    Column("nonce", String(64), nullable=False),
    Column("browser", String(64), nullable=False),
    Column("registration", String(64), ForeignKey(_REGISTRATION), nullable=False),
    Column("target", ADDRESS, nullable=False),
    Column("deployment", NAME),
    Column("storage_target", NAME),
    Column("parameters", Text, nullable=False),
    Column("expires_at", UtcTime, nullable=False, index=True),
    Column("used_at", UtcTime),
)

# A context of a platform is a course. ``key`` is the id of the key of its tokens and sessions;
# ``memberships_url`` is that of the roster (NRPS), and ``shows_names`` is true if a tutor wants it.
contexts = Table(
    "lti_contexts",
    metadata,
    Column("number", RowNumber, primary_key=True),
    Column("registration", String(64), ForeignKey(_REGISTRATION), nullable=False),
    Column("deployment", NAME, nullable=False),
    Column("context", NAME, nullable=False),
    Column("course", String(64), ForeignKey(courses.c.id), nullable=False, index=True),
    Column("key", String(8)),
    Column("memberships_url", ADDRESS),
    Column("shows_names", Boolean, nullable=False),
    Column("roster_at", UtcTime),
    UniqueConstraint("registration", "deployment", "context"),
)

# A resource link is an assignment, or NULL until a tutor has chosen its exercises. The addresses
# and ``scopes``, separated by spaces, are those of the last launch (AGS).
resource_links = Table(
    "lti_resource_links",
    metadata,
    Column("number", RowNumber, primary_key=True),
    Column("context", RowNumber, ForeignKey(contexts.c.number), nullable=False),
    Column("link", NAME, nullable=False),
    Column("title", String(200), nullable=False),
    Column("assignment", RowNumber, ForeignKey(assignments.c.number), index=True),
    Column("lineitem_url", ADDRESS),
    Column("lineitems_url", ADDRESS),
    Column("scopes", Text, nullable=False),
    Column("launched_at", UtcTime, nullable=False),
    UniqueConstraint("context", "link"),
)

# A user of a platform. ``learner`` is the pseudonym in courses and attempts.
learners = Table(
    "lti_learners",
    metadata,
    Column("registration", String(64), ForeignKey(_REGISTRATION), primary_key=True),
    Column("sub", NAME, primary_key=True),
    Column("learner", String(200), nullable=False, unique=True),
    Column("launched_at", UtcTime),
)

# A column of the platform's gradebook. ``is_own`` is true if this service has made it.
line_items = Table(
    "lti_line_items",
    metadata,
    Column("number", RowNumber, primary_key=True),
    Column("context", RowNumber, ForeignKey(contexts.c.number), nullable=False),
    Column("resource_link", RowNumber, ForeignKey(resource_links.c.number)),
    Column("assignment", RowNumber, ForeignKey(assignments.c.number), nullable=False),
    Column("url", ADDRESS),
    Column("max_points", Float, nullable=False),
    Column("is_own", Boolean, nullable=False),
    Column("found_at", UtcTime),
    UniqueConstraint("resource_link", "assignment"),
    Index(None, "assignment"),
)

# The outbox: the last score of each learner in each line item. ``state`` is ``waiting``, ``sent``
# or ``refused``; ``version`` counts changes, so that a sender sees one that was made meanwhile.
# ``stamp`` is the timestamp of the last score that was sent. The lowest ``priority`` goes first.
scores = Table(
    "lti_scores",
    metadata,
    Column("line_item", RowNumber, ForeignKey(line_items.c.number), primary_key=True),
    Column("learner", String(200), primary_key=True, index=True),
    Column("sub", NAME, nullable=False),
    Column("points", Float),
    Column("max_points", Float, nullable=False),
    Column("version", Integer, nullable=False),
    Column("wanted_at", UtcTime, nullable=False),
    Column("submitted_at", UtcTime),
    Column("state", String(10), nullable=False),
    Column("priority", Integer, nullable=False),
    Column("tries", Integer, nullable=False),
    Column("next_try_at", UtcTime, nullable=False),
    Column("leased_by", String(32)),
    Column("leased_until", UtcTime),
    Column("stamp", UtcTime),
    Column("sent_at", UtcTime),
    Column("sent_points", Float),
    Column("refusal", Text),
    Index(None, "state", "priority", "next_try_at"),
)

# One-time links for dynamic registration; only a digest of the link is stored.
invitations = Table(
    "lti_invitations",
    metadata,
    Column("digest", String(64), primary_key=True),
    Column("name", String(200), nullable=False),
    Column("address", ADDRESS, nullable=False),
    Column("zone", String(64), nullable=False),
    Column("created_at", UtcTime, nullable=False),
    Column("expires_at", UtcTime, nullable=False),
    Column("used_at", UtcTime),
    Column("registration", String(64), ForeignKey(_REGISTRATION)),
)

# Files that a student has handed in at a platform: one row for each notice about them. The files
# and their reports are not stored; ``content`` has their addresses, and what they are graded with.
# ``state`` is ``waiting``, ``sent`` or ``refused``.
handed_files = Table(
    "lti_handed_files",
    metadata,
    Column("number", RowNumber, primary_key=True),
    Column("registration", String(64), ForeignKey(_REGISTRATION), nullable=False),
    Column("notice", NAME, nullable=False),
    Column("submission", NAME, nullable=False),
    Column("learner", String(200), nullable=False, index=True),
    Column("content", Text, nullable=False),
    Column("received_at", UtcTime, nullable=False, index=True),
    Column("state", String(10), nullable=False),
    Column("tries", Integer, nullable=False),
    Column("next_try_at", UtcTime, nullable=False),
    Column("leased_until", UtcTime),
    Column("refusal", Text),
    UniqueConstraint("registration", "notice"),
    Index(None, "state", "next_try_at"),
    Index(None, "registration", "submission"),
)
