"""The lines of the log on requests: without query strings, and without addresses if so wished."""

import logging


class _Discreet(logging.Filter):
    """Leaves out of uvicorn's lines what says more than which route was asked and how it went."""

    def __init__(self, *, addresses: bool) -> None:
        super().__init__()
        self.addresses = addresses

    def filter(self, record: logging.LogRecord) -> bool:
        """Shorten the line; it is always written."""
        if isinstance(record.args, tuple) and len(record.args) == 5:
            client, method, path, version, status = record.args
            path = str(path).partition("?")[0]
            record.args = (client if self.addresses else "-", method, path, version, status)
        return True


def set_up_access_log(*, addresses: bool) -> None:
    """Shorten the lines on requests from now on."""
    logger = logging.getLogger("uvicorn.access")
    for old in [f for f in logger.filters if isinstance(f, _Discreet)]:
        logger.removeFilter(old)
    logger.addFilter(_Discreet(addresses=addresses))
