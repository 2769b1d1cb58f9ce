"""`dh-grader serve`: start the service with its settings, in one process or several."""

import gc
import logging
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import uvicorn
from fastapi import FastAPI

from service.catalogue import CatalogueError
from service.catalogue.drafts import drafts_folder
from service.server.connections.protocol import GuardedProtocol
from service.server.installed import installed_app
from service.server.processes.process import Server
from service.server.processes.shared_port import SharedPort
from service.server.processes.workers import Supervisor
from service.server.watching.logs import log_config
from service.server.watching.metrics_folder import shared_metrics_folder
from service.settings import Settings

_log = logging.getLogger("uvicorn.error")


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
            _log.handle(logging.makeLogRecord(vars(record) | {"created": time.time()}))

    _log.addFilter(hold)
    try:
        yield announce
    finally:
        _log.removeFilter(hold)


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
