"""The folder in which processes share their metrics."""

# This module does not import the metrics.

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from service.catalogue.files.temporary import temporary_place
from service.settings import Settings, SettingsError
from service.translations import say

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
