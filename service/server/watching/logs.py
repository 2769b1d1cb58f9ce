"""The format of the log: text, or one JSON object for each line."""

import json
import logging
from datetime import UTC, datetime
from typing import Any, Final, Literal

from service.api.http.request_context import current_request

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
_JSON: Final = {name: {"()": "service.server.watching.logs.JsonLines"} for name in _STREAMS}


def log_config(form: Literal["text", "json"]) -> dict[str, Any]:
    """Return the configuration of the log for ``logging.config``."""
    return {
        "version": 1,
        "disable_existing_loggers": False,
        "filters": {"requests": {"()": "service.server.watching.logs.RequestIds"}},
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
