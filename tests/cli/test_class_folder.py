"""Grade a class folder in several processes, even if some files are broken."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from dh_grader.cli.running import WorkerLostError, mapped
from dh_grader.submissions.documents import UnusableFileError
from dh_grader.submissions.files import read_file

from tests.benchmarks.class_folder import BROKEN, EXERCISE, write_class
from tests.guards import ANSWER

pytestmark = pytest.mark.skipif(os.name == "nt", reason="has no pipes and links in folders")

COUNT = 51
PROGRAM = (sys.executable, "-m", "dh_grader", "grade", "--exercise", EXERCISE)


@pytest.fixture(scope="module")
def folder() -> Iterator[Path]:
    # Not below pytest's own folders, which other users cannot enter.
    with tempfile.TemporaryDirectory() as temporary:
        Path(temporary).chmod(0o755)
        write_class(Path(temporary) / "class", COUNT)
        yield Path(temporary) / "class"


@pytest.fixture(scope="module")
def run(folder: Path) -> subprocess.CompletedProcess[bytes]:
    command = [*PROGRAM, str(folder), "--format", "json", "--jobs", "2"]
    return subprocess.run(command, capture_output=True, check=False, timeout=ANSWER)


@pytest.fixture(scope="module")
def entries(run: subprocess.CompletedProcess[bytes]) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(run.stdout)
    return found


@pytest.mark.long
def test_all_usable_submissions_are_graded(entries: list[dict[str, Any]]) -> None:
    assert len(entries) == COUNT + len(BROKEN)
    broken = {Path(entry["file"]).name: entry["error"] for entry in entries if "error" in entry}
    assert broken.keys() == BROKEN.keys()
    assert all(BROKEN[name] in reason for name, reason in broken.items())


@pytest.mark.long
def test_submissions_are_sorted_by_name(entries: list[dict[str, Any]], folder: Path) -> None:
    names = [Path(entry["submission"]).relative_to(folder).parts[0] for entry in entries]
    assert names == sorted(names)


@pytest.mark.long
def test_broken_files_are_reported_without_a_traceback(
    run: subprocess.CompletedProcess[bytes],
) -> None:
    assert run.returncode == 2
    lines = run.stderr.decode().splitlines()
    assert len(lines) == len(BROKEN)
    # A log has no progress bar.
    assert b"Grading" not in run.stderr


@pytest.mark.long
def test_one_process_gives_the_same_result(
    run: subprocess.CompletedProcess[bytes], folder: Path, tmp_path: Path
) -> None:
    output = tmp_path / "out.json"
    command = [*PROGRAM, str(folder), "--format", "json", "--jobs", "1", "--output", str(output)]
    subprocess.run(command, stderr=subprocess.DEVNULL, check=False, timeout=ANSWER)
    assert output.read_bytes() == run.stdout


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="needs another user")
def test_a_file_without_permission_is_reported(folder: Path) -> None:
    closed = folder.parent / "closed.json"
    closed.write_text("{}", encoding="utf-8")
    closed.chmod(0)
    os.seteuid(65534)
    try:
        with pytest.raises(UnusableFileError, match="cannot be read: Permission denied"):
            read_file(closed)
    finally:
        os.seteuid(0)


@pytest.mark.long
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_the_run_and_leaves_no_files_or_processes(
    folder: Path, tmp_path: Path, number: signal.Signals
) -> None:
    output = tmp_path / "out.csv"
    output.write_text("from yesterday", encoding="utf-8")
    command = [*PROGRAM, *[str(folder)] * 40, "--format", "csv", "--jobs", "2", "--force"]
    process = subprocess.Popen(
        [*command, "--output", str(output)],
        stderr=subprocess.PIPE,
        start_new_session=True,
        # The suite may run in the background of a script, where interrupts are ignored.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )
    try:
        # The file that is being written shows that the grading has begun.
        wait_for(lambda: (tmp_path / ".out.csv.part").exists() or process.poll() is not None)
        assert process.poll() is None, process.communicate()
        # A process that has just begun may not have its own command line yet.
        wait_for(lambda: len(workers(process.pid)) == 2)
        # The run does not end by itself before the signal comes.
        for worker in workers(process.pid):
            os.kill(worker, signal.SIGSTOP)
        # Like a terminal, send the signal to all processes of the group.
        os.killpg(process.pid, number)
        _, stderr = process.communicate(timeout=ANSWER)
    finally:
        process.kill()
        process.wait()
    assert process.returncode == 128 + number, stderr
    assert b"Traceback" not in stderr
    assert [file.name for file in tmp_path.iterdir()] == ["out.csv"]
    assert output.read_text(encoding="utf-8") == "from yesterday"
    wait_for(lambda: not group(process.pid))


def wait_for(condition: Any) -> None:
    end = time.monotonic() + ANSWER
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def processes() -> Iterator[tuple[int, int, int]]:
    """Yield the id, parent and group of each running process."""
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, parent, group_id = entry.read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        if state != "Z":
            yield int(entry.parent.name), int(parent), int(group_id)


def children(pid: int) -> list[int]:
    return [each for each, parent, _ in processes() if parent == pid]


def workers(pid: int) -> list[int]:
    return [each for each in children(pid) if b"spawn_main" in command_of(each)]


def command_of(pid: int) -> bytes:
    return Path(f"/proc/{pid}/cmdline").read_bytes()


def group(pid: int) -> list[int]:
    return [each for each, _, group_id in processes() if group_id == pid]


def test_a_killed_worker_raises_an_error() -> None:
    with (
        mapped(os._exit, [1] * 20, jobs=2) as results,
        pytest.raises(WorkerLostError),
    ):
        list(results)
