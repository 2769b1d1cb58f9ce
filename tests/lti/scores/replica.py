"""A process that sends scores until it is killed.

``python -m tests.lti.scores.replica URL FILE SECRET``

The file has the seconds that are added to the time of this machine.
"""

import sys
import time
from datetime import UTC, datetime, timedelta
from pathlib import Path

from service.access.keys import Secret
from service.attempts.storage.database import open_database
from service.lti.scores.sender import ScoreSender


def main(url: str, file: str, secret: str) -> None:
    added = Path(file)

    def now() -> datetime:
        return datetime.now(UTC) + timedelta(seconds=float(added.read_text() or 0))

    sender = ScoreSender(open_database(url), Secret(secret), now)
    while True:
        if not sender.send_next():
            time.sleep(0.02)


if __name__ == "__main__":
    main(*sys.argv[1:])
