"""Run the migrations on the given connection; Alembic calls this module."""

from alembic import context
from dh_grader.store.tables import metadata

connection = context.config.attributes["connection"]
context.configure(connection=connection, target_metadata=metadata, render_as_batch=True)
context.run_migrations()
