"""The log of the service, and the folder in which processes share their metrics.

The metrics themselves are in ``metrics.py``, which a service without metrics does not import.
"""

import json
import logging
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from typing import Any, Final, Literal

from dh_grader.api.http import current_request
from dh_grader.catalogue.files import temporary_place
from dh_grader.settings import Settings, SettingsError
from dh_grader.translations import say

# --- The format of the log: text, or one JSON object for each line


_STREAMS: Final = {"default": "ext://sys.stderr", "access": "ext://sys.stdout"}
_TEXT: Final = {
    "default": {
        "()": "uvicorn.logging.DefaultFormatter",
        "fmt": "%(levelprefix)s %(message)s%(of_request)s",
    },
    "access": {
        "()": "uvicorn.logging.AccessFormatter",
        "fmt": '%(levelprefix)s %(client_addr)s - "%(request_line)s" %(status_code)s%(of_request)s',
    },
}
_JSON: Final = {name: {"()": "dh_grader.server.watching.JsonLines"} for name in _STREAMS}


def log_config(form: Literal["text", "json"]) -> dict[str, Any]:
    """Return the configuration of the log for ``logging.config``."""
    return {
        "version": 1,
        "disable_existing_loggers": False,
        "filters": {"requests": {"()": "dh_grader.server.watching.RequestIds"}},
        "formatters": _JSON if form == "json" else _TEXT,
        "handlers": {
            name: {
                "class": "logging.StreamHandler",
                "formatter": name,
                "filters": ["requests"],
                "stream": stream,
            }
            for name, stream in _STREAMS.items()
        },
        "loggers": {
            "uvicorn": {"handlers": ["default"], "level": "INFO", "propagate": False},
            "uvicorn.error": {"level": "INFO"},
            "uvicorn.access": {"handlers": ["access"], "level": "INFO", "propagate": False},
        },
        # All other parts of the program.
        "root": {"handlers": ["default"], "level": "WARNING"},
    }


class RequestIds(logging.Filter):
    """Adds the id of the current request to each line of the log."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Add the id of the current request to a line; return True, to keep the line."""
        request = current_request()
        record.request = request
        record.of_request = f" [{request.id}]" if request else ""
        return True


class JsonLines(logging.Formatter):
    """Formats each line as a JSON object."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line as a JSON object."""
        line: dict[str, Any] = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
        }
        request = getattr(record, "request", None)
        if request is not None:
            line["request_id"] = request.id
        if record.name == "uvicorn.access" and isinstance(record.args, tuple):
            client, method, path, _, status = record.args
            line |= {"client": client, "method": method, "path": path, "status": status}
            if request is not None:
                line["milliseconds"] = round(1e3 * request.seconds, 3)
        if record.exc_info:
            line["exception"] = self.formatException(record.exc_info)
        # Escaped to ASCII: no character of an address ends the line or turns it around.
        return json.dumps(line)


# --- Remove query strings, and optionally client addresses, from the access log


class _AccessLogFilter(logging.Filter):
    def __init__(self, *, addresses: bool) -> None:
        super().__init__()
        self.addresses = addresses

    def filter(self, record: logging.LogRecord) -> bool:
        if isinstance(record.args, tuple) and len(record.args) == 5:
            client, method, path, version, status = record.args
            path = str(path).partition("?")[0]
            record.args = (client if self.addresses else "-", method, path, version, status)
        return True


def set_up_access_log(*, addresses: bool) -> None:
    """Shorten the lines of the access log from now on."""
    logger = logging.getLogger("uvicorn.access")
    for old in [f for f in logger.filters if isinstance(f, _AccessLogFilter)]:
        logger.removeFilter(old)
    logger.addFilter(_AccessLogFilter(addresses=addresses))


# --- The folder in which processes share their metrics


# The environment variable in which prometheus_client looks for the folder.
FOLDER: Final = "PROMETHEUS_MULTIPROC_DIR"


@contextmanager
def shared_metrics_folder(settings: Settings) -> Iterator[Callable[[int], None]]:
    """Create a metrics folder for processes started in this context. Raises SettingsError.

    Yields a function that removes the gauges of an ended process.
    """
    if settings.metrics == "off" or settings.workers == 1:
        yield lambda _: None
        return
    try:
        place = temporary_place()
        folder = tempfile.TemporaryDirectory(prefix="dh-grader-metrics-", dir=place)
    except OSError as error:
        raise SettingsError(
            say(
                "DH_GRADER_METRICS: with several workers a folder for temporary files must be "
                "writable: {reason}",
                reason=str(error),
            )
        ) from error
    with folder as name:
        os.environ[FOLDER] = name
        try:
            yield _forget
        finally:
            del os.environ[FOLDER]


def _forget(process: int) -> None:
    # The counters of the process stay.
    from prometheus_client.multiprocess import mark_process_dead

    mark_process_dead(process)  # type: ignore[no-untyped-call]
