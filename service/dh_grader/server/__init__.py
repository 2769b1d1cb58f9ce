"""`dh-grader serve`: the application of an installation, in one process or several.

The other files bound connections, share turns, and watch. Routes are in ``api`` and ``web``.
"""

import gc
import logging
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import uvicorn
from fastapi import FastAPI

from dh_grader.access import WRONG_SECRET, Keys, KeysUnreachableError
from dh_grader.api.application import application
from dh_grader.api.permissions import Access, RequestRates, is_loopback
from dh_grader.catalogue import CatalogueError, open_catalogue
from dh_grader.catalogue.load import Drafts, drafts_folder
from dh_grader.server.connections import GuardedProtocol
from dh_grader.server.processes import Server, SharedPort, Supervisor
from dh_grader.server.turns import FairAdmission
from dh_grader.server.watching import log_config, set_up_access_log, shared_metrics_folder
from dh_grader.settings import Settings, SettingsError
from dh_grader.store.database import UnusableDatabaseError
from dh_grader.translations import joined, say
from dh_grader.web import Tutoring, web_routes

if TYPE_CHECKING:
    from dh_grader.store import AttemptStore


# --- `dh-grader serve`: start the service with its settings, in one process or several


_start_log = logging.getLogger("uvicorn.error")


def serve(settings: Settings) -> bool:
    """Serve until a signal comes; return False if the port is not available.

    Raises CatalogueError, SettingsError.
    """
    with shared_metrics_folder(settings) as forget:
        app = installed_app(settings, settings.host)
        if settings.workers == 1:
            server = _server(settings, app)
            server.run()
            return server.started
        config = _config(settings, app)
        gc.enable()
        # The workers read the exercises themselves; this process has read them to check them.
        try:
            with _delayed_announcement() as announcement:
                listener = config.bind_socket()
        except SystemExit:
            return False
        drafts = drafts_folder()
        work = partial(_work, settings, drafts)
        try:
            return Supervisor(work, listener, settings.workers, announcement, forget).run()
        finally:
            shutil.rmtree(drafts, ignore_errors=True)


@contextmanager
def _delayed_announcement() -> Iterator[Callable[[], None]]:
    # uvicorn would write the line as soon as it has the port, before any worker listens.
    held: list[logging.LogRecord] = []

    def hold(record: logging.LogRecord) -> bool:
        if record.levelno == logging.INFO:
            held.append(record)
        return record.levelno != logging.INFO

    def announce() -> None:
        for record in held:
            _start_log.handle(logging.makeLogRecord(vars(record) | {"created": time.time()}))

    _start_log.addFilter(hold)
    try:
        yield announce
    finally:
        _start_log.removeFilter(hold)


def _server(settings: Settings, app: FastAPI, port: SharedPort | None = None) -> Server:
    return Server(_config(settings, app), port, settings.cors_origins, app.state.monitor)


def _config(settings: Settings, app: object) -> uvicorn.Config:
    return uvicorn.Config(
        app,  # type: ignore[arg-type]
        host=settings.host,
        port=settings.port,
        http=GuardedProtocol,
        ws="none",
        log_config=log_config(settings.log_format),
        log_level=settings.log_level,
        server_header=False,
        workers=settings.workers,
    )


def _work(settings: Settings, drafts: Path, port: SharedPort) -> None:
    # Ctrl+C reaches all processes of the terminal. Until the server has its own handlers, only the
    # supervisor reacts.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        app = installed_app(settings, drafts=drafts)
    except CatalogueError as error:
        print(error, file=sys.stderr)  # noqa: T201 - the reason why this process ends
        raise SystemExit(1) from error
    _server(settings, app, port).run()


# --- Build the application of an installation from its settings


_installed_log = logging.getLogger(__name__)


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
        from dh_grader.store import AttemptStore

        try:
            store = AttemptStore.open(settings.database.get_secret_value())
        except UnusableDatabaseError as error:
            raise SettingsError(joined(": ", ["DH_GRADER_DATABASE", error.args[0]])) from error
        if settings.keep_months is not None:
            _delete_old(store, settings.keep_months)
    metrics = None
    if settings.metrics != "off":
        # Imported only here, because it imports the Prometheus client.
        from dh_grader.server.watching import Metrics

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
        from dh_grader.access.keys import KeyRing

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
    from dh_grader.store.database import in_transaction
    from dh_grader.store.results import delete_older, months_before

    before = months_before(datetime.now(UTC), months)
    count = in_transaction(store.engine, lambda connection: delete_older(connection, before))
    if count:
        _installed_log.info("%d attempts before %s were deleted", count, f"{before:%Y-%m-%d}")


def _is_here(host: str) -> bool:
    return host == "localhost" or is_loopback(host)


def _rates(settings: Settings) -> RequestRates | None:
    given = (settings.key_rate, settings.address_rate, settings.rates_store)
    if not any(each is not None for each in given):
        return None
    # Imported only here: few installations limit the rate of requests.
    from dh_grader.access.keys import Rates, UnusableRatesError, rates_in

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
