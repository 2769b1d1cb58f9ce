"""`python -m dh_grader.web.check_process`: check exercise files for the service.

The service starts this process. The process ends with the service, or after some idle minutes.
"""

import os
import queue
import sys
import threading
import traceback
from contextlib import suppress

from dh_grader.translations import ENGLISH, LANGUAGES
from dh_grader.web.tutor_checks import (
    DONE,
    IDLE_SECONDS,
    READY,
    CheckRequest,
    checked,
    received,
    send,
)

# Grading for students has priority over a tutor's checks.
_NICE = 5


def main() -> None:
    """Reply to each request with the findings, or with an empty message if a check crashes."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # Text that is printed by mistake must not get into the answers.
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    if hasattr(os, "nice"):
        os.nice(_NICE)
    bodies: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(bodies,), daemon=True).start()
    # Load the algebra system now, so that no check has to wait for it.
    import dh_grader.authoring  # noqa: F401

    with suppress(BrokenPipeError, queue.Empty):
        send(answers, READY)
        while True:
            code, _, body = bodies.get(timeout=IDLE_SECONDS).partition(b"\n")
            try:
                language = LANGUAGES.get(code.decode(), ENGLISH)
                content = checked(CheckRequest.model_validate_json(body), language)
            except Exception:  # noqa: BLE001 - the service answers 500, and the log says why
                traceback.print_exc()
                content = b""
            send(answers, DONE, content)


def _read(bodies: "queue.SimpleQueue[bytes]") -> None:
    # Read requests from standard input, and queue them for the checks.
    # When the service has ended, end the process at once, even during a check.
    with suppress(EOFError):
        while True:
            bodies.put(received(sys.stdin.buffer)[1])
    os._exit(0)


if __name__ == "__main__":
    main()
