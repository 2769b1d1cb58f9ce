"""Remove query strings, and optionally client addresses, from the access log."""

import logging


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
