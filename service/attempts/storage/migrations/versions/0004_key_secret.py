"""Of the secret of the keys a keyed hash, by which another secret is known."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    """Make the table. It stays empty until the next key is made: nothing else tells the secret."""
    op.create_table(
        "key_secrets",
        sa.Column("id", sa.Integer, primary_key=True, autoincrement=False),
        sa.Column("digest", sa.String(64), nullable=False),
    )
