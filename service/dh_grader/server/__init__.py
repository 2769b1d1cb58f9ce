"""`dh-grader serve`: the application of an installation, in one process or several.

It knows processes and the settings. How a process limits its connections is in ``connections.py``,
how requests take turns in ``turns.py``; routes are in ``api`` and ``web``.
"""

import asyncio
import contextlib
import gc
import logging
import multiprocessing
import os
import shutil
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import Context
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, Final

import uvicorn
from fastapi import FastAPI

from dh_grader.access import WRONG_SECRET, Keys, KeysUnreachableError
from dh_grader.api.application import application
from dh_grader.api.http import Monitor
from dh_grader.api.permissions import Access, RequestRates, is_loopback
from dh_grader.catalogue import CatalogueError, open_catalogue
from dh_grader.catalogue.load import Drafts, drafts_folder
from dh_grader.server.connections import FORCED_EXIT, GRACE, GuardedProtocol, GuardedState
from dh_grader.server.turns import FairAdmission
from dh_grader.server.watching import log_config, set_up_access_log, shared_metrics_folder
from dh_grader.settings import Settings, SettingsError
from dh_grader.store import UnusableDatabaseError
from dh_grader.translations import joined, say
from dh_grader.web import Tutoring, web_routes

if TYPE_CHECKING:
    from dh_grader.store.attempt_store import AttemptStore


# --- `dh-grader serve`: start the service with its settings, in one process or several


# The log of uvicorn, whose lines the operator sees.
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


def _server(settings: Settings, app: FastAPI, port: "SharedPort | None" = None) -> "Server":
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


def _work(settings: Settings, drafts: Path, port: "SharedPort") -> None:
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


_own_log = logging.getLogger(__name__)


def installed_app(
    settings: Settings, host: str | None = None, drafts: Path | None = None
) -> FastAPI:
    """Return the application of an installation. Raises CatalogueError, SettingsError.

    ``host`` is the address on which the service listens, or None if it was checked already.
    ``drafts`` is the folder with drafts of exercises from the editor.
    """
    catalogue = open_catalogue(settings.exercises_dir, reload=settings.reload_exercises)
    store = None
    if settings.database is not None:
        # Imported only here, because it imports the database drivers.
        from dh_grader.store.attempt_store import AttemptStore

        try:
            store = AttemptStore.open(settings.database.get_secret_value())
        except UnusableDatabaseError as error:
            raise SettingsError(joined(": ", ["DH_GRADER_DATABASE", error.args[0]])) from error
        if settings.keep_months is not None:
            _delete_old(store, settings.keep_months)
    metrics = None
    if settings.metrics != "off":
        # Imported only here, because it imports the Prometheus client.
        from dh_grader.server.metrics import Metrics

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
        from dh_grader.access.key_ring import KeyRing

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
    is_here = host == "localhost" or (host is not None and is_loopback(host))
    if host is not None and not (is_here or has_keys or settings.open is not None):
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
        _own_log.info("%d attempts before %s were deleted", count, f"{before:%Y-%m-%d}")


def _rates(settings: Settings) -> RequestRates | None:
    given = (settings.key_rate, settings.address_rate, settings.rates_store)
    if not any(each is not None for each in given):
        return None
    # Imported only here: few installations limit the rate of requests.
    from dh_grader.access.rates import Rates, UnusableRatesError, rates_in

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


# --- One server process: uvicorn with limits for connections, and an orderly shutdown


# The log line after the first signal, so that nobody sends a second one by mistake.
SHUTTING_DOWN: Final = (
    f"Shutting down: open requests are still answered, for at most {GRACE:g} s. "
    "A second signal ends the process at once."
)
_SIGNALS: Final = (signal.SIGINT, signal.SIGTERM)


class Server(uvicorn.Server):
    """A server that, after a signal, answers open requests and exits within ten seconds."""

    def __init__(
        self,
        config: uvicorn.Config,
        port: "SharedPort | None" = None,
        origins: Sequence[str] = (),
        monitor: Monitor | None = None,
    ) -> None:
        super().__init__(config)
        self.server_state: GuardedState = GuardedState(origins, monitor)
        self._port = port
        # The process id of this worker's supervisor. The worker ends if the supervisor dies.
        self._parent = port.supervisor if port else None
        self._acceptor: Acceptor | None = None

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Handle signals while the server runs, so that a signal leads to exit code 0."""
        before = {number: signal.signal(number, self.handle_exit) for number in _SIGNALS}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:  # noqa: ARG002
        """Begin to shut down; at a second signal, end at once."""
        if self._parent is not None:
            # A worker ignores Ctrl+C, which also reaches the supervisor; that ends the workers.
            self.should_exit = self.should_exit or sig == signal.SIGTERM
        elif self.should_exit:
            signal.signal(sig, signal.SIG_DFL)
            signal.raise_signal(sig)
        else:
            self.should_exit = True
            # An empty context: the log line must not name the request that was interrupted.
            Context().run(_log.info, SHUTTING_DOWN)

    async def on_tick(self, counter: int) -> bool:
        """True if the server has to end, because of a signal or a dead supervisor."""
        if self._acceptor is not None:
            self._acceptor.publish_count()
        orphaned = self._parent is not None and os.getppid() != self._parent
        return await super().on_tick(counter) or orphaned

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen on the port that all workers share, or on a separate port of this process."""
        if self._port is None:
            await super().startup(sockets)
            return
        await super().startup(sockets=[])
        self._acceptor = Acceptor(
            self._port, lambda: len(self.server_state.connections), self._connection
        )

    def _connection(self) -> GuardedProtocol:
        return GuardedProtocol(self.config, self.server_state, self.lifespan.state)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:  # noqa: ARG002
        """Answer open requests for a while, then close all connections."""
        _force_exit_later()
        for server in self.servers:
            server.close()
        if self._acceptor is not None:
            self._acceptor.close()
        connections = self.server_state.connections
        for connection in self._guarded():
            connection.shutdown()
        loop = asyncio.get_running_loop()
        end = loop.time() + GRACE
        while connections and loop.time() < end:
            await asyncio.sleep(0.02)
        for connection in self._guarded():
            connection.reset()
        if tasks := list(self.server_state.tasks):
            # They notice that their clients have gone.
            _, hanging = await asyncio.wait(tasks, timeout=0.5)
            for task in hanging:
                task.cancel()
        await self.lifespan.shutdown()

    def _guarded(self) -> list[GuardedProtocol]:
        found = list(self.server_state.connections)
        return [connection for connection in found if isinstance(connection, GuardedProtocol)]


def _force_exit_later() -> None:
    # Without this, Python would wait for a thread that is still running.
    def end() -> None:
        _log.warning(
            "Something does not react, for example the database: exiting without waiting for it."
        )
        os._exit(0)

    timer = threading.Timer(GRACE + FORCED_EXIT, end)
    timer.daemon = True
    timer.start()


# --- Several worker processes that serve one port, and their supervisor


# Seconds after the grace period until a worker is killed.
_MARGIN: Final = 1.5
# Seconds between two checks whether the first worker listens.
_POLL: Final = 0.05


class Supervisor:
    """Keeps ``number`` workers running until a signal comes."""

    def __init__(
        self,
        work: "Callable[[SharedPort], None]",
        listener: socket.socket,
        number: int,
        announce: Callable[[], None],
        lost: Callable[[int], None] = lambda _: None,
    ) -> None:
        # Called as soon as a worker listens; logs that the service is running.
        self._announce = announce
        # Called with the process id of a worker that has ended.
        self._lost = lost
        self._work = work
        self._listener = listener
        self._counts = ConnectionCounts.of(number)
        self._workers: list[BaseProcess] = []
        self._signals = 0
        self._last = signal.SIGTERM.value

    def run(self) -> bool:
        """Run until a signal comes; return False if no worker could start."""
        # A signal writes to this socket, which wakes the process.
        awake, alarm = socket.socketpair()
        with awake, alarm:
            alarm.setblocking(False)
            signal.set_wakeup_fd(alarm.fileno())
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, self._note)
            self._workers = [self._start(index) for index in range(len(self._counts.numbers))]
            started = self._watch(awake)
            self._listener.close()
            self._end(awake)
            signal.set_wakeup_fd(-1)
        if self._signals > 1:
            # As without workers, the second signal ends this process.
            signal.signal(self._last, signal.SIG_DFL)
            signal.raise_signal(self._last)
        return started

    def _note(self, number: int, _: object) -> None:
        self._signals += 1
        self._last = number

    def _start(self, index: int) -> BaseProcess:
        # A new interpreter: a fork would copy locks that another thread holds.
        context = multiprocessing.get_context("spawn")
        port = SharedPort(self._listener, self._counts, index, os.getpid())
        worker = context.Process(target=self._work, args=(port,))
        worker.start()
        return worker

    def _watch(self, awake: socket.socket) -> bool:
        announced = False
        while True:
            wait(
                [awake, *(worker.sentinel for worker in self._workers)],
                None if announced else _POLL,
            )
            if self._stopped():
                return True
            if not announced and self._counts.any_listening:
                announced = True
                self._announce()
            gone = [worker for worker in self._workers if not worker.is_alive()]
            if len(gone) == len(self._workers) and all(worker.exitcode == 1 for worker in gone):
                return False
            if not gone:
                continue
            for worker in gone:
                _log.error("Worker %s has ended (exit code %s)", worker.pid, worker.exitcode)
                self._counts.stop_listening(self._workers.index(worker))
                self._lost(worker.pid or 0)
            wait([awake], _PAUSE)
            if self._stopped():
                return True
            self._workers = [
                self._start(index) if worker in gone else worker
                for index, worker in enumerate(self._workers)
            ]

    def _stopped(self) -> bool:
        return self._signals > 0

    def _end(self, awake: socket.socket) -> None:
        _log.info(SHUTTING_DOWN)
        for worker in self._workers:
            worker.terminate()
        end = time.monotonic() + GRACE + _MARGIN
        while alive := [worker for worker in self._workers if worker.is_alive()]:
            left = end - time.monotonic()
            if self._signals > 1 or left <= 0:
                for worker in alive:
                    worker.kill()
                break
            awake.setblocking(False)
            _drain(awake)
            wait([awake, *(worker.sentinel for worker in alive)], left)
        for worker in self._workers:
            worker.join()


def _drain(awake: socket.socket) -> None:
    try:
        awake.recv(64)
    except BlockingIOError:
        return


# --- Balance the connections of a shared port between worker processes
#
# A worker that has more connections than another pauses for a moment, so that the other accepts
# some. The system wakes all workers, and the first one awake would accept all waiting connections.


# The number of connections of a process that does not listen.
_AWAY: Final = 2**31 - 1
# A worker with n connections more than another one pauses if n is at least _MORE plus one for each
# _PER connections of the other.
_MORE: Final = 1
_PER: Final = 8
# Seconds of this pause; after it the worker accepts a connection, because the other one is busy.
_MOMENT: Final = 0.005
# Seconds until the next attempt if no connection can be opened, or if a worker has ended.
_PAUSE: Final = 1.0
# How many connections the system queues until they are accepted.
_BACKLOG: Final = 2048
# How many connections are accepted before the accepted ones are read.
_AT_ONCE: Final = 32


@dataclass(frozen=True)
class ConnectionCounts:
    """The number of connections of each process, in shared memory."""

    # An array of the C type int.
    numbers: Any

    @classmethod
    def of(cls, number: int) -> "ConnectionCounts":
        """Return new counts for ``number`` processes."""
        return cls(multiprocessing.get_context("spawn").RawArray("i", [_AWAY] * number))

    @property
    def any_listening(self) -> bool:
        """True if at least one process listens."""
        return any(count != _AWAY for count in self.numbers)

    def stop_listening(self, index: int) -> None:
        """Record that the process with this index no longer accepts connections."""
        self.numbers[index] = _AWAY


@dataclass(frozen=True)
class SharedPort:
    """A port that several workers share, and the index of this worker."""

    listener: socket.socket
    counts: ConnectionCounts
    index: int
    # The process id of the supervisor.
    supervisor: int


class Acceptor:
    """Accepts connections from a shared port, about as many as other processes do."""

    def __init__(
        self,
        port: SharedPort,
        connections: Callable[[], int],
        protocol: Callable[[], asyncio.Protocol],
    ) -> None:
        self._port = port
        self._connections = connections
        self._protocol = protocol
        self._loop = asyncio.get_running_loop()
        self._waiting: asyncio.TimerHandle | None = None
        self._tasks: set[asyncio.Task[Any]] = set()
        port.listener.setblocking(False)
        port.listener.listen(_BACKLOG)
        self._listen()

    def close(self) -> None:
        """Stop accepting connections."""
        self._loop.remove_reader(self._port.listener)
        self._port.listener.close()
        if self._waiting is not None:
            self._waiting.cancel()
        self._port.counts.stop_listening(self._port.index)

    def publish_count(self) -> int:
        """Publish this worker's number of connections; return the smallest one of other workers."""
        here, counts = self._port.index, self._port.counts.numbers
        counts[here] = self._count()
        return min((n for index, n in enumerate(counts) if index != here), default=_AWAY)

    def _count(self) -> int:
        return self._connections() + len(self._tasks)

    def _listen(self) -> None:
        self.publish_count()
        self._loop.add_reader(self._port.listener, self._accept_some)

    def _has_more(self) -> bool:
        least = self.publish_count()
        return self._count() >= least + _MORE + least // _PER

    def _accept_some(self) -> None:
        for _ in range(_AT_ONCE):
            if self._has_more():
                self._wait(_MOMENT)
                return
            if not self._accept():
                return

    def _accept(self) -> bool:
        try:
            connection, _ = self._port.listener.accept()
        except (BlockingIOError, InterruptedError, ConnectionAbortedError):
            return False
        except OSError:
            self._wait(_PAUSE)
            return False
        connection.setblocking(False)
        opening = self._loop.connect_accepted_socket(self._protocol, connection)
        task = self._loop.create_task(opening)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return True

    def _wait(self, seconds: float) -> None:
        self._loop.remove_reader(self._port.listener)
        self._waiting = self._loop.call_later(seconds, self._resume)

    def _resume(self) -> None:
        self._waiting = None
        self._accept()
        if self._waiting is None:
            self._listen()
