"""A process that starts and kills senders of scores on command.

``python -m tests.lti.replica URL FILE SECRET``
"""

import os
import signal
import sys
import time
from datetime import UTC, datetime, timedelta
from pathlib import Path

from dh_grader.access import Secret
from dh_grader.lti.outbox import ScoreSender
from dh_grader.store.database import open_database

# FILE has the seconds that are added to the time of this machine. Each line of the input is `start`
# or `kill` with a number of children; the process answers with the line `done`. A child begins at
# once, because its parent has already imported the service.


def main(url: str, file: str, secret: str) -> None:
    running: list[int] = []
    for line in sys.stdin:
        word, number = line.split()
        for _ in range(int(number)):
            if word == "kill":
                child = running.pop(0)
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
            elif child := os.fork():
                running.append(child)
            else:
                send(url, Path(file), secret)
        print("done", flush=True)  # noqa: T201
    for child in running:
        os.kill(child, signal.SIGKILL)


def send(url: str, added: Path, secret: str) -> None:
    def now() -> datetime:
        return datetime.now(UTC) + timedelta(seconds=float(added.read_text() or 0))

    sender = ScoreSender(open_database(url), Secret(secret), now)
    while True:
        if not sender.send_next():
            time.sleep(0.05)


if __name__ == "__main__":
    main(*sys.argv[1:])
