"""Store the numbers that the variants of an assignment may have.

So a correction of the exercise file does not change the variants of learners.
"""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    """Add the column ``choices``."""
    op.add_column("assignments", sa.Column("choices", sa.Text))
