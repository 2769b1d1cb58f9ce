"""Add tables for LTI: platforms, their courses, assignments and users, and scores to send."""

import sqlalchemy as sa
from alembic import op
from dh_grader.store.tables import RowNumber, UtcTime

revision = "0006"
down_revision = "0005"

_NAME = sa.String(255)
_ADDRESS = sa.String(1000)
_INDEXES = (
    ("lti_launches", ["expires_at"]),
    ("lti_contexts", ["course"]),
    ("lti_resource_links", ["assignment"]),
    ("lti_line_items", ["assignment"]),
    ("lti_scores", ["learner"]),
    ("lti_scores", ["state", "priority", "next_try_at"]),
)


def upgrade() -> None:
    """Create the tables."""
    _create_platforms()
    _create_links()
    _create_scores()
    for table, columns in _INDEXES:
        op.create_index(f"ix_{table}_{'_'.join(columns)}", table, columns)


def _create_platforms() -> None:
    op.create_table(
        "lti_registrations",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("issuer", _ADDRESS, nullable=False),
        sa.Column("client_id", _NAME, nullable=False),
        sa.Column("auth_url", _ADDRESS, nullable=False),
        sa.Column("jwks_url", _ADDRESS, nullable=False),
        sa.Column("token_url", _ADDRESS),
        sa.Column("audience", _ADDRESS),
        sa.Column("address", _ADDRESS, nullable=False),
        sa.Column("zone", sa.String(64), nullable=False),
        sa.Column("any_deployment", sa.Boolean, nullable=False),
        sa.Column("is_development", sa.Boolean, nullable=False),
        sa.Column("created_at", UtcTime, nullable=False),
        sa.Column("launched_at", UtcTime),
        sa.Column("refused_at", UtcTime),
        sa.Column("refusal", sa.String(64)),
        sa.UniqueConstraint("issuer", "client_id", name="uq_lti_registrations_issuer_client_id"),
    )
    op.create_table(
        "lti_deployments",
        sa.Column(
            "registration", sa.String(64), sa.ForeignKey("lti_registrations.id"), primary_key=True
        ),
        sa.Column("deployment", _NAME, primary_key=True),
        sa.Column("created_at", UtcTime, nullable=False),
    )
    op.create_table(
        "lti_own_keys",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column("private_key", sa.Text, nullable=False),
        sa.Column("public_key", sa.Text, nullable=False),
        sa.Column("created_at", UtcTime, nullable=False),
        sa.Column("signs_from", UtcTime, nullable=False),
    )
    op.create_table(
        "lti_launches",
        sa.Column("state", sa.String(64), primary_key=True),
        sa.Column("nonce", sa.String(64), nullable=False),
        sa.Column("browser", sa.String(64), nullable=False),
        sa.Column(
            "registration", sa.String(64), sa.ForeignKey("lti_registrations.id"), nullable=False
        ),
        sa.Column("target", _ADDRESS, nullable=False),
        sa.Column("deployment", _NAME),
        sa.Column("storage_target", _NAME),
        sa.Column("parameters", sa.Text, nullable=False),
        sa.Column("expires_at", UtcTime, nullable=False),
        sa.Column("used_at", UtcTime),
    )
    op.create_table(
        "lti_invitations",
        sa.Column("digest", sa.String(64), primary_key=True),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("address", _ADDRESS, nullable=False),
        sa.Column("zone", sa.String(64), nullable=False),
        sa.Column("created_at", UtcTime, nullable=False),
        sa.Column("expires_at", UtcTime, nullable=False),
        sa.Column("used_at", UtcTime),
        sa.Column("registration", sa.String(64), sa.ForeignKey("lti_registrations.id")),
    )


def _create_links() -> None:
    op.create_table(
        "lti_contexts",
        sa.Column("number", RowNumber, primary_key=True),
        sa.Column(
            "registration", sa.String(64), sa.ForeignKey("lti_registrations.id"), nullable=False
        ),
        sa.Column("deployment", _NAME, nullable=False),
        sa.Column("context", _NAME, nullable=False),
        sa.Column("course", sa.String(64), sa.ForeignKey("courses.id"), nullable=False),
        sa.Column("key", sa.String(8)),
        sa.Column("memberships_url", _ADDRESS),
        sa.Column("shows_names", sa.Boolean, nullable=False),
        sa.Column("roster_at", UtcTime),
        sa.UniqueConstraint(
            "registration",
            "deployment",
            "context",
            name="uq_lti_contexts_registration_deployment_context",
        ),
    )
    op.create_table(
        "lti_resource_links",
        sa.Column("number", RowNumber, primary_key=True),
        sa.Column("context", RowNumber, sa.ForeignKey("lti_contexts.number"), nullable=False),
        sa.Column("link", _NAME, nullable=False),
        sa.Column("title", sa.String(200), nullable=False),
        sa.Column("assignment", RowNumber, sa.ForeignKey("assignments.number")),
        sa.Column("lineitem_url", _ADDRESS),
        sa.Column("lineitems_url", _ADDRESS),
        sa.Column("scopes", sa.Text, nullable=False),
        sa.Column("launched_at", UtcTime, nullable=False),
        sa.UniqueConstraint("context", "link", name="uq_lti_resource_links_context_link"),
    )
    op.create_table(
        "lti_learners",
        sa.Column(
            "registration", sa.String(64), sa.ForeignKey("lti_registrations.id"), primary_key=True
        ),
        sa.Column("sub", _NAME, primary_key=True),
        sa.Column("learner", sa.String(200), nullable=False),
        sa.UniqueConstraint("learner", name="uq_lti_learners_learner"),
        sa.Column("launched_at", UtcTime),
    )


def _create_scores() -> None:
    op.create_table(
        "lti_line_items",
        sa.Column("number", RowNumber, primary_key=True),
        sa.Column("context", RowNumber, sa.ForeignKey("lti_contexts.number"), nullable=False),
        sa.Column("resource_link", RowNumber, sa.ForeignKey("lti_resource_links.number")),
        sa.Column("assignment", RowNumber, sa.ForeignKey("assignments.number"), nullable=False),
        sa.Column("url", _ADDRESS),
        sa.Column("max_points", sa.Float, nullable=False),
        sa.Column("is_own", sa.Boolean, nullable=False),
        sa.Column("found_at", UtcTime),
        sa.UniqueConstraint(
            "resource_link", "assignment", name="uq_lti_line_items_resource_link_assignment"
        ),
    )
    op.create_table(
        "lti_scores",
        sa.Column("line_item", RowNumber, sa.ForeignKey("lti_line_items.number"), primary_key=True),
        sa.Column("learner", sa.String(200), primary_key=True),
        sa.Column("sub", _NAME, nullable=False),
        sa.Column("points", sa.Float),
        sa.Column("max_points", sa.Float, nullable=False),
        sa.Column("version", sa.Integer, nullable=False),
        sa.Column("wanted_at", UtcTime, nullable=False),
        sa.Column("submitted_at", UtcTime),
        sa.Column("state", sa.String(10), nullable=False),
        sa.Column("priority", sa.Integer, nullable=False),
        sa.Column("tries", sa.Integer, nullable=False),
        sa.Column("next_try_at", UtcTime, nullable=False),
        sa.Column("leased_by", sa.String(32)),
        sa.Column("leased_until", UtcTime),
        sa.Column("stamp", UtcTime),
        sa.Column("sent_at", UtcTime),
        sa.Column("sent_points", sa.Float),
        sa.Column("refusal", sa.Text),
    )
