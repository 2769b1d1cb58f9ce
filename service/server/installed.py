"""The application of this installation, as its settings want it."""

from typing import TYPE_CHECKING

from fastapi import FastAPI

from service.access.keys import WRONG_SECRET, Keys, KeysUnreachableError
from service.api.application import application
from service.api.permissions.access import Access, is_loopback
from service.api.permissions.authentication import RequestRates
from service.attempts.errors import UnusableDatabaseError
from service.catalogue import open_catalogue
from service.server.turns.admission import FairAdmission
from service.server.watching.access_log import set_up_access_log
from service.settings import Settings, SettingsError
from service.web import Tutoring, web_routes

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore


def installed_app(settings: Settings, host: str | None = None) -> FastAPI:
    """The application, with fair admission; ``host`` is where it listens, if that is known.

    Raises CatalogueError, SettingsError.
    """
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
        from service.server.watching.metrics import Metrics

        metrics = Metrics(tells_all=settings.metrics == "all")
        if store is not None:
            store.measure = metrics.store
    access = Access(
        settings.open_access,
        solutions=settings.solutions,
        read_attempts=settings.read_attempts,
        keys=_keys(settings, store, host),
    )
    tutoring = Tutoring(
        access, settings.exercises_dir, settings.editor_dir, records=store is not None
    )
    app = application(
        catalogue,
        settings.cors_origins,
        access=access,
        rates=_rates(settings),
        feedback=settings.feedback,
        turns=FairAdmission if metrics is None else metrics.fair_admission,
        store=store,
        pages=web_routes(catalogue, tutoring),
        monitor=metrics,
    )
    # For what is refused before the application has a say.
    app.state.monitor = metrics
    if metrics is not None:
        app.include_router(metrics.routes())
    set_up_access_log(addresses=settings.log_addresses)
    return app


def _keys(settings: Settings, store: "AttemptStore | None", host: str | None) -> Keys | None:
    """The keys, where there may be any. Raises SettingsError for a service open to strangers."""
    secret = settings.known_secret()
    ring = None
    if store is not None:
        # Only here: it loads the drivers of databases.
        from service.access.key_ring import KeyRing

        try:
            ring = KeyRing(store.engine, secret)
        except KeysUnreachableError as error:
            raise SettingsError("DH_GRADER_DATABASE: does not answer") from error
        if ring.has_keys and secret is None:
            raise SettingsError(
                "DH_GRADER_SECRET: is needed, for there are keys; set it, or "
                "DH_GRADER_SECRET_FILE, to the secret that they were made with"
            )
        if not ring.has_their_secret:
            raise SettingsError(f"DH_GRADER_SECRET: {WRONG_SECRET}")
    has_keys = ring is not None and ring.has_keys
    if host is not None and not (_is_here(host) or has_keys or settings.open is not None):
        raise SettingsError(
            f"DH_GRADER_HOST: {host} lets others than this machine in, and there are no keys. Make "
            "one with dh-grader keys create, or say that the service is open to whoever reaches it:"
            " DH_GRADER_OPEN=until-keys"
        )
    return ring


def _is_here(host: str) -> bool:
    return host == "localhost" or is_loopback(host)


def _rates(settings: Settings) -> RequestRates | None:
    if settings.key_rate is None and settings.address_rate is None:
        return None
    # Only here: few installations count requests.
    from service.access.rates import Rates, UnusableRatesError, rates_in

    for name in ("key_rate", "address_rate"):
        try:
            rates_in(getattr(settings, name) or "1/second")
        except UnusableRatesError as error:
            raise SettingsError(f"DH_GRADER_{name.upper()}: {error}") from error
    store = settings.rates_store.get_secret_value() if settings.rates_store else "memory://"
    try:
        return Rates(settings.key_rate or "", settings.address_rate or "", store)
    except UnusableRatesError as error:
        raise SettingsError(f"DH_GRADER_RATES_STORE: {error}") from error
