"""Regrade by several processes and kill some: ``python -m tests.store.shared_regrade``.

Check that every attempt in a PostgreSQL database was regraded exactly once.
"""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from dh_grader.catalogue import load_catalogue, shipped_folder
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.tables import attempts, earlier_reports, regrade_queue
from rich.console import Console
from sqlalchemy import func, select

from tests.api.serving import ROOT
from tests.store.campaign import fill
from tests.store.databases import new_database, postgresql_server

WORKERS = 4
KILLED = 2
_LOOK = 0.05

show = Console(highlight=False, soft_wrap=True).print


def corrected(folder: Path) -> str:
    text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
    text = text.replace('kind = "dh_table"\n', 'kind = "dh_table"\nmarking = "rows"\n', 1)
    (folder / "scara.toml").write_text(text, encoding="utf-8")
    return load_catalogue(folder)["scara"].version


def regraded(store: AttemptStore, url: str, folder: Path, workers: int, killed: int) -> float:
    dice = random.Random(1)
    settings = {"DH_GRADER_DATABASE": url, "DH_GRADER_EXERCISES_DIR": str(folder)}
    # By another marking rule, the exercise's own check expects other points.
    command = [
        sys.executable,
        "-m",
        "dh_grader",
        "attempts",
        "regrade",
        "scara",
        "--apply",
        "--force",
    ]
    with store.engine.connect() as connection:
        total = connection.scalar(select(func.count()).select_from(attempts)) or 0
    begun = time.monotonic()
    running = [
        subprocess.Popen(command, cwd=ROOT, env=os.environ | settings, stdout=subprocess.DEVNULL)
        for _ in range(workers)
    ]
    try:
        for i in range(killed):
            # Kill each worker in its own part of the first half of the work.
            _wait_for(store, int(total * (i + dice.random()) / (2 * killed)) + 1)
            running[i].send_signal(signal.SIGKILL)
            show(f"killed worker {i + 1} after {time.monotonic() - begun:.1f} s")
        exits = [each.wait() for each in running]
    finally:
        for each in running:
            each.kill()
            each.wait()
    assert exits == [-signal.SIGKILL] * killed + [0] * (workers - killed), exits
    return time.monotonic() - begun


def _wait_for(store: AttemptStore, done: int) -> None:
    while True:
        with store.engine.connect() as connection:
            if (connection.scalar(select(func.max(earlier_reports.c.id))) or 0) >= done:
                return
        time.sleep(_LOOK)


def check(store: AttemptStore, version: str, count: int) -> None:
    """Assert that every attempt was regraded exactly once."""
    with store.engine.connect() as connection:
        times = Counter(connection.scalars(select(earlier_reports.c.attempt)))
        versions = Counter(connection.scalars(select(attempts.c.version)))
        waiting = connection.scalar(select(func.count()).select_from(regrade_queue))
    assert (len(times), set(times.values())) == (count, {1})
    assert versions == {version: count}
    assert waiting == 0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1_000_000)
    count = parser.parse_args().count
    with tempfile.TemporaryDirectory() as folder, postgresql_server() as server:
        url = new_database(server, "attempts")
        store = AttemptStore.open(url)
        fill(store, load_catalogue(shipped_folder())["scara"], count)
        version = corrected(Path(folder))
        seconds = regraded(store, url, Path(folder), WORKERS, KILLED)
        check(store, version, count)
        store.close()
    show(f"{count} attempts, each regraded once, by {WORKERS} workers of which {KILLED} died:")
    show(f"{seconds:.0f} s, {count / seconds:.0f} a second")


if __name__ == "__main__":
    main()
