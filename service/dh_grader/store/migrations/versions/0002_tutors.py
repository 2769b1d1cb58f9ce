"""Tables for tutors: awarded points, earlier reports, and the queue of regrades."""

import sqlalchemy as sa
from alembic import op
from dh_grader.store.tables import RowNumber, UtcTime

revision = "0002"
down_revision = "0001"

_BEFORE = (["exercise", "number"], ["learner", "number"], ["exercise", "outcome"])
_NOW = {
    "ix_attempts_at": ["at", "number", "ordinal"],
    "ix_attempts_exercise": ["exercise", "at", "number", "ordinal"],
    "ix_attempts_learner": ["learner", "at", "number", "ordinal"],
    "ix_attempts_outcome": ["exercise", "outcome", "answers_digest", "learner", "at"],
}
_UNCOUNTED = {
    "ix_attempts_uncounted": ["at", "number"],
    "ix_attempts_exercise_uncounted": ["exercise", "at", "number"],
}


def upgrade() -> None:
    """Create the tables, and indexes to list and count attempts without reading reports."""
    for columns in _BEFORE:
        op.drop_index(f"ix_attempts_{'_'.join(columns)}", "attempts")
    for name, columns in _NOW.items():
        op.create_index(name, "attempts", columns)
    few = sa.text("ordinal IS NULL")
    for name, columns in _UNCOUNTED.items():
        op.create_index(name, "attempts", columns, sqlite_where=few, postgresql_where=few)
    op.add_column("attempts", sa.Column("awarded", sa.Float))
    op.create_table(
        "overrides",
        sa.Column("id", RowNumber, primary_key=True),
        sa.Column("attempt", RowNumber, sa.ForeignKey("attempts.number"), nullable=False),
        sa.Column("points", sa.Float),
        sa.Column("reason", sa.Text, nullable=False),
        sa.Column("author", sa.String(200), nullable=False),
        sa.Column("at", UtcTime, nullable=False),
    )
    op.create_table(
        "earlier_reports",
        sa.Column("id", RowNumber, primary_key=True),
        sa.Column("attempt", RowNumber, sa.ForeignKey("attempts.number"), nullable=False),
        sa.Column("replaced_at", UtcTime, nullable=False),
        sa.Column("report", sa.Text, nullable=False),
        sa.Column("version", sa.String(64), nullable=False),
        sa.Column("grader", sa.String(32), nullable=False),
        sa.Column("points", sa.Float, nullable=False),
        sa.Column("max_points", sa.Float, nullable=False),
    )
    op.create_table(
        "regrade_queue",
        sa.Column("attempt", RowNumber, sa.ForeignKey("attempts.number"), primary_key=True),
        sa.Column("exercise", sa.String(100), nullable=False),
    )
    op.create_index("ix_overrides_attempt", "overrides", ["attempt"])
    op.create_index("ix_earlier_reports_attempt", "earlier_reports", ["attempt"])
    op.create_index("ix_regrade_queue_exercise_attempt", "regrade_queue", ["exercise", "attempt"])
