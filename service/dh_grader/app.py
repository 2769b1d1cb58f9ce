"""The application for `uvicorn dh_grader.app:app`, configured by environment variables."""

import gc

from fastapi import FastAPI

from dh_grader.catalogue import CatalogueError
from dh_grader.server import installed_app
from dh_grader.settings import SettingsError, load_settings

# Loading modules produces no garbage, and searching them for it takes a twentieth of the start.
_COLLECTS = gc.isenabled()
gc.disable()


def create() -> FastAPI:
    """Return the service; exit with a message if a setting or exercise is invalid."""
    try:
        return installed_app(load_settings())
    except (SettingsError, CatalogueError) as error:
        raise SystemExit(f"dh-grader cannot start:\n{error}") from error


try:
    app = create()
finally:
    if _COLLECTS:
        gc.enable()
