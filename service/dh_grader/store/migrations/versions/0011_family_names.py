"""Add the family names of learners, by which lists are sorted."""

import sqlalchemy as sa
from alembic import op

revision = "0011"
down_revision = "0010"


def upgrade() -> None:
    """Add the column."""
    op.add_column("course_learners", sa.Column("family_name", sa.String(200)))
