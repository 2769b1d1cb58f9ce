"""Add courses, their learners and assignments, and keys for one course or one learner."""

import sqlalchemy as sa
from alembic import op
from dh_grader.store.tables import RowNumber, UtcTime

revision = "0005"
down_revision = "0004"

_INDEXES = {
    "ix_attempts_assigned": ["exercise", "learner", "assignment", "ordinal"],
    "ix_attempts_assignment": [
        "assignment", "learner", "exercise", "ordinal", "points", "max_points", "awarded",
        "is_late",
    ],
}  # fmt: skip


def upgrade() -> None:
    """Create the tables. Recorded attempts belong to no assignment."""
    op.create_table(
        "courses",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("title", sa.String(200), nullable=False),
        sa.Column("zone", sa.String(64), nullable=False),
        sa.Column("created_at", UtcTime, nullable=False),
    )
    op.create_table(
        "course_learners",
        sa.Column("course", sa.String(64), sa.ForeignKey("courses.id"), primary_key=True),
        sa.Column("learner", sa.String(200), primary_key=True),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("email", sa.String(254)),
    )
    op.create_table(
        "assignments",
        sa.Column("number", RowNumber, primary_key=True),
        sa.Column("course", sa.String(64), sa.ForeignKey("courses.id"), nullable=False),
        sa.Column("id", sa.String(64), nullable=False),
        sa.Column("title", sa.String(200), nullable=False),
        sa.Column("exercises", sa.Text, nullable=False),
        sa.Column("opens", UtcTime),
        sa.Column("due", UtcTime),
        sa.Column("closes", UtcTime),
        sa.Column("max_attempts", sa.Integer),
        sa.Column("late_worth", sa.Float, nullable=False),
        sa.Column("feedback", sa.Text),
        sa.Column("practice", sa.String(10), nullable=False),
        sa.Column("solution", sa.String(10), nullable=False),
        sa.UniqueConstraint("course", "id", name="uq_assignments_course_id"),
    )
    op.create_table(
        "extensions",
        sa.Column("assignment", RowNumber, sa.ForeignKey("assignments.number"), primary_key=True),
        sa.Column("learner", sa.String(200), primary_key=True),
        sa.Column("due", UtcTime),
        sa.Column("closes", UtcTime),
        sa.Column("max_attempts", sa.Integer),
    )
    # Alembic would copy the whole table in SQLite to add a column with a foreign key.
    kind = "BIGINT" if op.get_context().dialect.name == "postgresql" else "INTEGER"
    op.execute(f"ALTER TABLE attempts ADD COLUMN assignment {kind} REFERENCES assignments (number)")
    for column, length in (("course", 64), ("learner", 200)):
        op.add_column("keys", sa.Column(column, sa.String(length)))
    for table in ("course_learners", "extensions"):
        op.create_index(f"ix_{table}_learner", table, ["learner"])
    op.create_index("ix_keys_course_learner", "keys", ["course", "learner"])
    assigned = sa.text("assignment IS NOT NULL")
    for name, columns in _INDEXES.items():
        op.create_index(name, "attempts", columns, sqlite_where=assigned, postgresql_where=assigned)
