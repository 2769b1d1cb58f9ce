"""`uvicorn service.app:app`: the service as the environment sets it up."""

from fastapi import FastAPI

from service.api.application import application
from service.catalogue import CatalogueError, open_catalogue
from service.kinds_check import check_kinds
from service.settings import SettingsError, load_settings


def create() -> FastAPI:
    """The service. Ends the process with the reason where a setting or exercise is unusable."""
    check_kinds()
    try:
        settings = load_settings()
        catalogue = open_catalogue(settings.exercises_dir, reload=settings.reload_exercises)
        return application(
            catalogue,
            settings.cors_origins,
            solutions=settings.solutions,
            feedback=settings.feedback,
        )
    except (SettingsError, CatalogueError) as error:
        raise SystemExit(f"dh-grader cannot start:\n{error}") from error


app = create()
