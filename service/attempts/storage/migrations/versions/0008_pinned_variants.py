"""Add the choices of the variants of an assignment, so that a corrected file keeps them."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    """Add the column. Assignments get their choices with the next hand-in."""
    op.add_column("assignments", sa.Column("choices", sa.Text))
