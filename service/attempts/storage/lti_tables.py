"""The tables of LTI: platforms, launches, linked courses, assignments and learners, and scores."""

from sqlalchemy import Boolean, Column, Float, ForeignKey, Index, Integer, String, Table, Text
from sqlalchemy import UniqueConstraint as Unique

from service.attempts.storage.tables import RowNumber, UtcTime, assignments, courses, metadata

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
    Unique("issuer", "client_id"),
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
    Unique("registration", "deployment", "context"),
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
    Unique("context", "link"),
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
    Unique("resource_link", "assignment"),
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
    Unique("registration", "notice"),
    Index(None, "state", "next_try_at"),
    Index(None, "registration", "submission"),
)
