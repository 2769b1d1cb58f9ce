"""The application of this installation, as its settings want it."""

from fastapi import FastAPI

from service.api.application import application
from service.api.tutor import tutor_right
from service.attempts.errors import UnusableDatabaseError
from service.catalogue import open_catalogue
from service.server.access_log import set_up_access_log
from service.server.admission import FairAdmission
from service.settings import Settings, SettingsError
from service.web import Tutoring, web_routes


def installed_app(settings: Settings) -> FastAPI:
    """The application, with fair admission. Raises CatalogueError, SettingsError."""
    catalogue = open_catalogue(settings.exercises_dir, reload=settings.reload_exercises)
    store = None
    if settings.database is not None:
        # Only here: it loads the drivers of databases.
        from service.attempts.store import AttemptStore

        try:
            store = AttemptStore.open(settings.database.get_secret_value())
        except UnusableDatabaseError as error:
            raise SettingsError(f"DH_GRADER_DATABASE: {error}") from error
    metrics = None
    if settings.metrics != "off":
        # Only here: who does not count loads nothing that counts.
        from service.server.metrics import Metrics

        metrics = Metrics()
        if store is not None:
            store.measure = metrics.store
    is_tutor = tutor_right(settings.solutions)
    tutoring = Tutoring(is_tutor, settings.exercises_dir, settings.editor_dir)
    app = application(
        catalogue,
        settings.cors_origins,
        solutions=settings.solutions,
        feedback=settings.feedback,
        turns=FairAdmission if metrics is None else metrics.fair_admission,
        store=store,
        read_attempts=settings.read_attempts,
        pages=web_routes(catalogue, tutoring),
        monitor=metrics,
    )
    if metrics is not None:
        may_read = tutor_right(True if settings.metrics == "all" else None)
        app.include_router(metrics.routes(may_read))
    set_up_access_log(addresses=settings.log_addresses)
    return app
