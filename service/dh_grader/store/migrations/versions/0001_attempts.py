"""Attempts and their outcomes."""

import sqlalchemy as sa
from alembic import op
from dh_grader.store.tables import RowNumber, UtcTime

revision = "0001"
down_revision = None


def upgrade() -> None:
    """Create the first tables."""
    op.create_table(
        "outcomes",
        sa.Column("id", RowNumber, primary_key=True),
        sa.Column("exercise", sa.String(100), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("content", sa.Text, nullable=False),
        sa.UniqueConstraint("exercise", "digest", name="uq_outcomes_exercise_digest"),
    )
    op.create_table(
        "attempts",
        sa.Column("number", RowNumber, primary_key=True),
        sa.Column("id", sa.String(32), nullable=False),
        sa.Column("exercise", sa.String(100), nullable=False),
        sa.Column("learner", sa.String(200), nullable=False),
        sa.Column("ordinal", sa.Integer),
        sa.Column("at", UtcTime, nullable=False),
        sa.Column("is_late", sa.Boolean, nullable=False),
        sa.Column("worth", sa.Float, nullable=False),
        sa.Column("submission", sa.Text, nullable=False),
        sa.Column("answers_digest", sa.String(64), nullable=False),
        sa.Column("report", sa.Text, nullable=False),
        sa.Column("version", sa.String(64), nullable=False),
        sa.Column("grader", sa.String(32), nullable=False),
        sa.Column("points", sa.Float, nullable=False),
        sa.Column("max_points", sa.Float, nullable=False),
        sa.Column("outcome", RowNumber, sa.ForeignKey("outcomes.id"), nullable=False),
        sa.Column("owner", sa.String(32), nullable=False),
        sa.Column("idempotency_key", sa.String(255)),
        sa.Column("request_digest", sa.String(64), nullable=False),
        sa.UniqueConstraint("id", name="uq_attempts_id"),
        sa.UniqueConstraint(
            "exercise", "learner", "ordinal", name="uq_attempts_exercise_learner_ordinal"
        ),
        sa.UniqueConstraint("owner", "idempotency_key", name="uq_attempts_owner_idempotency_key"),
    )
    for columns in (["exercise", "number"], ["learner", "number"], ["exercise", "outcome"]):
        op.create_index(f"ix_attempts_{'_'.join(columns)}", "attempts", columns)
