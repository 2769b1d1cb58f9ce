"""Add the files that students submit on platforms and that this service grades."""

import sqlalchemy as sa
from alembic import op
from dh_grader.store.tables import RowNumber, UtcTime

revision = "0010"
down_revision = "0009"

_ID = sa.ForeignKey("lti_registrations.id")
_INDEXES = (
    ["state", "next_try_at"],
    ["registration", "submission"],
    ["learner"],
    ["received_at"],
)


def upgrade() -> None:
    """Create the table."""
    op.create_table(
        "lti_handed_files",
        sa.Column("number", RowNumber, primary_key=True),
        sa.Column("registration", sa.String(64), _ID, nullable=False),
        sa.Column("notice", sa.String(255), nullable=False),
        sa.Column("submission", sa.String(255), nullable=False),
        sa.Column("learner", sa.String(200), nullable=False),
        sa.Column("content", sa.Text, nullable=False),
        sa.Column("received_at", UtcTime, nullable=False),
        sa.Column("state", sa.String(10), nullable=False),
        sa.Column("tries", sa.Integer, nullable=False),
        sa.Column("next_try_at", UtcTime, nullable=False),
        sa.Column("leased_until", UtcTime),
        sa.Column("refusal", sa.Text),
        sa.UniqueConstraint(
            "registration", "notice", name="uq_lti_handed_files_registration_notice"
        ),
    )
    for columns in _INDEXES:
        op.create_index(f"ix_lti_handed_files_{'_'.join(columns)}", "lti_handed_files", columns)
