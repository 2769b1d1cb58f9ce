"""Add variants to attempts and assignments, and the number of variants that a learner has got."""

import sqlalchemy as sa
from alembic import op
from dh_grader.store.tables import RowNumber

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    """Add the columns and the table. Recorded attempts and assignments have no variants."""
    op.add_column("attempts", sa.Column("variant", sa.String(20)))
    op.add_column("assignments", sa.Column("variants", sa.String(64)))
    op.create_table(
        "deals",
        sa.Column("assignment", RowNumber, sa.ForeignKey("assignments.number"), primary_key=True),
        sa.Column("learner", sa.String(200), primary_key=True),
        sa.Column("exercise", sa.String(100), primary_key=True),
        sa.Column("number", sa.Integer, nullable=False),
    )
    op.create_index("ix_deals_learner", "deals", ["learner"])
