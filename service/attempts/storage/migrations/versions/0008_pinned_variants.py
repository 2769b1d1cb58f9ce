"""Store what an assignment's variants may vary, so that a corrected file changes no variant."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    """Add the column ``choices``. An assignment gets its choices with the next hand-in."""
    op.add_column("assignments", sa.Column("choices", sa.Text))
