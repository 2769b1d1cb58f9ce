"""Build the application of an installation from its settings."""

import logging
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fastapi import FastAPI

from service.access.keys import WRONG_SECRET, Keys, KeysUnreachableError
from service.api.application import application
from service.api.permissions.access import Access, is_loopback
from service.api.permissions.authentication import RequestRates
from service.attempts.errors import UnusableDatabaseError
from service.catalogue import open_catalogue
from service.catalogue.drafts import Drafts
from service.server.turns.admission import FairAdmission
from service.server.watching.access_log import set_up_access_log
from service.settings import Settings, SettingsError
from service.translations import joined, say
from service.web import Tutoring, web_routes

if TYPE_CHECKING:  # it imports the database drivers
    from service.attempts.store import AttemptStore

_log = logging.getLogger(__name__)


def installed_app(
    settings: Settings, host: str | None = None, drafts: Path | None = None
) -> FastAPI:
    """Return the application of an installation. Raises CatalogueError, SettingsError.

    ``drafts`` is the folder with drafts of exercises from the editor.
    """
    # ``host`` is the address on which the service listens, or None if it was checked already.
    catalogue = open_catalogue(settings.exercises_dir, reload=settings.reload_exercises)
    store = None
    if settings.database is not None:
        # Imported only here, because it imports the database drivers.
        from service.attempts.store import AttemptStore

        try:
            store = AttemptStore.open(settings.database.get_secret_value())
        except UnusableDatabaseError as error:
            raise SettingsError(joined(": ", ["DH_GRADER_DATABASE", error.args[0]])) from error
        if settings.keep_months is not None:
            _delete_old(store, settings.keep_months)
    metrics = None
    if settings.metrics != "off":
        # Imported only here, because it imports the Prometheus client.
        from service.server.watching.metrics import Metrics

        metrics = Metrics(is_public=settings.metrics == "all")
        if store is not None:
            store.measure = metrics.store
    access = Access(
        settings.open_access,
        solutions=settings.solutions,
        read_attempts=settings.read_attempts,
        keys=_keys(settings, store, host),
    )
    tutoring = Tutoring(
        access,
        settings.exercises_dir,
        settings.editor_dir,
        store is not None,
        store,
        drafts=Drafts(drafts),
        feedback=settings.feedback,
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
        public_url=settings.public_url,
    )
    # It also counts the requests that are refused before they reach the application.
    app.state.monitor = metrics
    if metrics is not None:
        app.include_router(metrics.routes())
    set_up_access_log(addresses=settings.log_addresses)
    return app


def _keys(settings: Settings, store: "AttemptStore | None", host: str | None) -> Keys | None:
    # Raises SettingsError if other machines could use the service without a key by mistake.
    secret = settings.known_secret()
    ring = None
    if store is not None:
        # Imported only here, because it imports the database drivers.
        from service.access.key_ring import KeyRing

        try:
            ring = KeyRing(store.engine, secret)
        except KeysUnreachableError as error:
            raise SettingsError(say("DH_GRADER_DATABASE: does not answer")) from error
        if ring.has_keys and secret is None:
            raise SettingsError(
                say(
                    "DH_GRADER_SECRET: is needed because API keys exist; set it, or "
                    "DH_GRADER_SECRET_FILE, to the secret with which they were created"
                )
            )
        if not ring.has_their_secret:
            raise SettingsError(joined(": ", ["DH_GRADER_SECRET", WRONG_SECRET]))
    has_keys = ring is not None and ring.has_keys
    if host is not None and not (_is_here(host) or has_keys or settings.open is not None):
        raise SettingsError(
            say(
                "DH_GRADER_HOST: other machines can reach {host}, but there are no API keys. "
                "Create one with dh-grader keys create, or allow everybody to use the service "
                "without a key: DH_GRADER_OPEN=until-keys",
                host=host,
            )
        )
    return ring


def _delete_old(store: "AttemptStore", months: int) -> None:
    from service.attempts.learner_data import delete_older, months_before
    from service.attempts.storage.database import in_transaction

    before = months_before(datetime.now(UTC), months)
    count = in_transaction(store.engine, lambda connection: delete_older(connection, before))
    if count:
        _log.info("%d attempts before %s were deleted", count, f"{before:%Y-%m-%d}")


def _is_here(host: str) -> bool:
    return host == "localhost" or is_loopback(host)


def _rates(settings: Settings) -> RequestRates | None:
    given = (settings.key_rate, settings.address_rate, settings.rates_store)
    if not any(each is not None for each in given):
        return None
    # Imported only here: few installations limit the rate of requests.
    from service.access.rates import Rates, UnusableRatesError, rates_in

    for name in ("key_rate", "address_rate"):
        try:
            rates_in(getattr(settings, name) or "1/second")
        except UnusableRatesError as error:
            named = f"DH_GRADER_{name.upper()}"
            raise SettingsError(joined(": ", [named, error.args[0]])) from error
    store = settings.rates_store.get_secret_value() if settings.rates_store else "memory://"
    try:
        rates = Rates(settings.key_rate or "", settings.address_rate or "", store)
    except UnusableRatesError as error:
        raise SettingsError(joined(": ", ["DH_GRADER_RATES_STORE", error.args[0]])) from error
    # An invalid store is refused even if nothing is counted in it.
    return rates if settings.key_rate or settings.address_rate else None
