"""The application for `uvicorn service.app:app`, configured by environment variables."""

import gc

# Loading modules produces no garbage, and searching them for it takes a twentieth of the start.
_COLLECTS = gc.isenabled()
gc.disable()

from fastapi import FastAPI

from service.catalogue import CatalogueError
from service.server.installed import installed_app
from service.settings import SettingsError, load_settings


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
