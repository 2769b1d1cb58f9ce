"""Add the priced hints that learners took, and the prices of hints in assignments."""

import sqlalchemy as sa
from alembic import op
from dh_grader.store.tables import RowNumber, UtcTime

revision = "0009"
down_revision = "0008"


def upgrade() -> None:
    """Add the columns and the table. Recorded attempts get the hint price 0."""
    op.add_column("attempts", sa.Column("hint_price", sa.Float, nullable=False, server_default="0"))
    op.add_column("assignments", sa.Column("hint_prices", sa.Text))
    op.create_table(
        "hints",
        sa.Column("id", RowNumber, primary_key=True),
        sa.Column("attempt", RowNumber, sa.ForeignKey("attempts.number"), nullable=False),
        sa.Column("part", sa.String(40), nullable=False),
        sa.Column("code", sa.String(40), nullable=False),
        sa.Column("row", sa.String(40), nullable=False),
        sa.Column("cell", sa.String(40), nullable=False),
        sa.Column("step", sa.Integer, nullable=False),
        sa.Column("price", sa.Float, nullable=False),
        sa.Column("at", UtcTime, nullable=False),
        sa.UniqueConstraint("attempt", "part", "row", "cell", "step"),
    )
