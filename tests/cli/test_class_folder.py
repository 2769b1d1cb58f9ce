"""Test the command that grades the folder of a class."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from dh_grader.cli.grade import UnusableFolderError, is_for_folder, write_folder
from dh_grader.cli.running import WorkerLostError, mapped
from dh_grader.formats.class_page import WRITTEN
from dh_grader.formats.graded import Document
from dh_grader.submissions.documents import UnusableFileError
from dh_grader.submissions.files import read_file
from typer.testing import Result

from tests.benchmarks.class_folder import BROKEN, EXERCISE, write_class
from tests.guards import ANSWER

# --- Grade a class folder in several processes, even if some files are broken

needs_pipes_and_links = pytest.mark.skipif(
    os.name == "nt", reason="has no pipes and links in folders"
)

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
def run_on_class(folder: Path) -> subprocess.CompletedProcess[bytes]:
    command = [*PROGRAM, str(folder), "--format", "json", "--jobs", "2"]
    return subprocess.run(command, capture_output=True, check=False, timeout=ANSWER)


@pytest.fixture(scope="module")
def entries(run_on_class: subprocess.CompletedProcess[bytes]) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(run_on_class.stdout)
    return found


@needs_pipes_and_links
@pytest.mark.long
def test_all_usable_submissions_are_graded(entries: list[dict[str, Any]]) -> None:
    assert len(entries) == COUNT + len(BROKEN)
    broken = {Path(entry["file"]).name: entry["error"] for entry in entries if "error" in entry}
    assert broken.keys() == BROKEN.keys()
    assert all(BROKEN[name] in reason for name, reason in broken.items())


@needs_pipes_and_links
@pytest.mark.long
def test_submissions_are_sorted_by_name(entries: list[dict[str, Any]], folder: Path) -> None:
    names = [Path(entry["submission"]).relative_to(folder).parts[0] for entry in entries]
    assert names == sorted(names)


@needs_pipes_and_links
@pytest.mark.long
def test_broken_files_are_reported_without_a_traceback(
    run_on_class: subprocess.CompletedProcess[bytes],
) -> None:
    assert run_on_class.returncode == 2
    lines = run_on_class.stderr.decode().splitlines()
    assert len(lines) == len(BROKEN)
    # A log has no progress bar.
    assert b"Grading" not in run_on_class.stderr


@needs_pipes_and_links
@pytest.mark.long
def test_one_process_gives_the_same_result(
    run_on_class: subprocess.CompletedProcess[bytes], folder: Path, tmp_path: Path
) -> None:
    output = tmp_path / "out.json"
    command = [*PROGRAM, str(folder), "--format", "json", "--jobs", "1", "--output", str(output)]
    subprocess.run(command, stderr=subprocess.DEVNULL, check=False, timeout=ANSWER)
    assert output.read_bytes() == run_on_class.stdout


@needs_pipes_and_links
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


@needs_pipes_and_links
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


@needs_pipes_and_links
def test_a_killed_worker_raises_an_error() -> None:
    with (
        mapped(os._exit, [1] * 20, jobs=2) as results,
        pytest.raises(WorkerLostError),
    ):
        list(results)


# --- A command writes its whole output folder, or nothing

NEEDS_LINKS = pytest.mark.skipif(os.name == "nt", reason="needs symbolic links")


def documents(*names: str, end: BaseException | None = None) -> Iterator[Document]:
    for name in names:
        yield Document(f"reports/{name}.html", [b"page of ", name.encode()])
    if end is not None:
        raise end
    yield Document("index.html", [b" ".join(name.encode() for name in names)])


def content(folder: Path) -> dict[str, str]:
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != WRITTEN)
    return {path.relative_to(folder).as_posix(): path.read_text() for path in files}


TWO = {"reports/a.html": "page of a", "reports/b.html": "page of b", "index.html": "a b"}


def test_a_new_folder_is_created_with_all_documents(tmp_path: Path) -> None:
    write_folder(documents("a", "b"), tmp_path / "class")
    assert content(tmp_path) == {f"class/{name}": text for name, text in TWO.items()}


def test_an_empty_folder_or_one_of_an_earlier_run_is_replaced(tmp_path: Path) -> None:
    for names in (("x", "y", "z"), ("a", "b")):
        write_folder(documents(*names), tmp_path)
    assert content(tmp_path) == TWO
    assert sorted(path.name for path in tmp_path.iterdir()) == [WRITTEN, "index.html", "reports"]


@pytest.mark.parametrize("end", [KeyboardInterrupt(), OSError(28, "No space left on device")])
@pytest.mark.parametrize("before", [(), ("a", "b")])
def test_an_interrupted_run_leaves_no_incomplete_folder(
    tmp_path: Path, before: tuple[str, ...], end: BaseException
) -> None:
    folder = tmp_path / "class"
    if before:
        write_folder(documents(*before), folder)
    with pytest.raises((KeyboardInterrupt, UnusableFolderError)):
        write_folder(documents("c", "d", end=end), folder)
    assert content(tmp_path) == {f"class/{name}": text for name, text in TWO.items() if before}
    assert folder.exists() is bool(before)


def test_a_failed_replacement_restores_the_old_content(tmp_path: Path) -> None:
    write_folder(documents("a", "b"), tmp_path)

    def with_somebody_else() -> Iterator[Document]:
        yield from documents("c")
        # Meanwhile another program writes to the folder, so that a name is taken.
        (tmp_path / "reports" / "late.html").write_text("late")
        (tmp_path / "last" / "x").mkdir(parents=True)
        yield Document("last", [b"a file"])

    with pytest.raises(UnusableFolderError, match="cannot be written"):
        write_folder(with_somebody_else(), tmp_path)
    assert content(tmp_path) == {**TWO, "reports/late.html": "late"}


@pytest.mark.parametrize("strange", ["notes.txt", "reports/notes.txt", "other/", "reports/deep/"])
def test_a_folder_with_foreign_content_is_refused(tmp_path: Path, strange: str) -> None:
    write_folder(documents("a", "b"), tmp_path)
    if strange.endswith("/"):
        (tmp_path / strange).mkdir()
    else:
        (tmp_path / strange).write_text("mine")
    with pytest.raises(UnusableFolderError, match="which no earlier run has written"):
        write_folder(documents("c"), tmp_path)
    assert content(tmp_path).items() >= TWO.items()
    assert (tmp_path / strange).exists()


def test_foreign_pages_are_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("my home page")
    with pytest.raises(UnusableFolderError, match=r"index\.html"):
        write_folder(documents("a"), tmp_path)
    assert content(tmp_path) == {"index.html": "my home page"}


@NEEDS_LINKS
def test_links_are_not_followed(tmp_path: Path) -> None:
    folder, elsewhere = tmp_path / "class", tmp_path / "elsewhere"
    write_folder(documents("a"), folder)
    elsewhere.mkdir()
    (elsewhere / "a.html").write_text("mine")
    (folder / "reports" / "a.html").unlink()
    (folder / "reports" / "a.html").symlink_to(elsewhere / "a.html")
    with pytest.raises(UnusableFolderError):
        write_folder(documents("b"), folder)
    assert content(elsewhere) == {"a.html": "mine"}


@pytest.mark.parametrize("path", ["../x.html", "/x.html", "a/../../x.html", "a/b/c.html", "a\nb"])
def test_no_path_leads_out_of_the_folder(tmp_path: Path, path: str) -> None:
    with pytest.raises(ValueError, match="does not stay in its folder"):
        write_folder([Document(path, [b"x"])], tmp_path / "class")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_whose_parent_is_missing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UnusableFolderError, match="cannot be written: No such file"):
        write_folder(documents("a"), tmp_path / "no" / "class")


def test_a_new_output_without_suffix_is_a_folder_for_several_submissions(
    tmp_path: Path,
) -> None:
    file = tmp_path / "file"
    file.touch()
    assert is_for_folder(tmp_path, several=False)
    assert is_for_folder(tmp_path / "new", several=True)
    assert not is_for_folder(tmp_path / "new", several=False)
    assert not is_for_folder(tmp_path / "new.HTML", several=True)
    assert not is_for_folder(file, several=True)


# --- Test `grade --shard` and `merge`: several machines grade one class

Run = Callable[..., Result]

RIGHT = "a, alpha, d, theta\n0, 0, 0, q1\nl1, 0, 0, q2\nl2, 0, 0, q3\nl3, 0, 0, 0\n"
GRADE = ("grade", "--exercise", "planar-rrr", "--part", "table", "--format", "jsonl")


@pytest.fixture
def folder_to_merge(tmp_path: Path) -> Path:
    folder = tmp_path / "class"
    folder.mkdir()
    for name in ("ada", "ben", "cem", "dan", "eva"):
        table = RIGHT if name in ("ada", "dan") else RIGHT.replace("l1", "l2")
        (folder / f"{name}.csv").write_text(table, encoding="utf-8")
    (folder / "fay").mkdir()
    for name in ("table.csv", "notes.txt"):
        (folder / "fay" / name).write_text(RIGHT, encoding="utf-8")
    (folder / "gus.csv").touch()
    return folder


def shards(run: Run, folder: Path, count: int) -> list[Path]:
    files = [folder.parent / f"{i}-of-{count}.jsonl" for i in range(1, count + 1)]
    for i, file in enumerate(files, start=1):
        result = run(*GRADE, folder, "--shard", f"{i}/{count}", "--output", file)
        assert file.exists(), result.output
    return files


@pytest.mark.parametrize("count", [1, 3, 9])
def test_merged_shards_are_the_same_as_one_run(run: Run, folder_to_merge: Path, count: int) -> None:
    whole = run(*GRADE, folder_to_merge)
    assert whole.exit_code == 2  # of the empty file
    assert len(whole.stdout.splitlines()) == 7
    merged = run("merge", *reversed(shards(run, folder_to_merge, count)))
    assert merged.stdout == whole.stdout
    assert merged.exit_code == whole.exit_code


def test_the_exit_code_of_merge_is_that_of_the_worst_submission(
    run: Run, folder_to_merge: Path
) -> None:
    (folder_to_merge / "gus.csv").unlink()
    assert run("merge", *shards(run, folder_to_merge, 2)).exit_code == 1
    for file in folder_to_merge.glob("*.csv"):
        file.write_text(RIGHT, encoding="utf-8")
    assert run("merge", *shards(run, folder_to_merge, 2)).exit_code == 0


def test_each_submission_is_in_exactly_one_shard(run: Run, folder_to_merge: Path) -> None:
    names = [
        [json.loads(line)["submission"] for line in file.read_text("utf-8").splitlines()[1:]]
        for file in shards(run, folder_to_merge, 3)
    ]
    assert [len(each) for each in names] == [3, 2, 2]
    assert len({name for each in names for name in each}) == 7


def test_shards_that_do_not_fit_together_are_refused(run: Run, folder_to_merge: Path) -> None:
    first, second, third = shards(run, folder_to_merge, 3)
    output = folder_to_merge.parent / "all.jsonl"

    def refused(*files: Path) -> str:
        result = run("merge", *files, "--output", output)
        assert result.exit_code == 2
        assert not output.exists()
        return result.stderr

    assert "Missing shards of 3: 2." in refused(first, third)
    assert "is shard 1, and so is" in refused(first, second, third, first)
    assert "is not a shard" in refused(first, folder_to_merge / "ada.csv")
    assert "cannot be read" in refused(first, folder_to_merge / "nobody.jsonl")
    lines = second.read_bytes()
    second.write_bytes(lines[: len(lines) // 2])
    assert f"{second} is incomplete" in refused(first, second, third)
    second.write_bytes(lines + lines.splitlines(keepends=True)[-1])
    assert f"{second} has more lines" in refused(first, second, third)
    (folder_to_merge / "zoe.csv").write_text(RIGHT, encoding="utf-8")
    run(*GRADE, folder_to_merge, "--shard", "2/3", "--output", second)
    assert "is from another run" in refused(first, second, third)


@pytest.mark.parametrize("text", ["0/3", "4/3", "3", "1/0", "-1/3", "1/1001", "１/3", "a/b"])
def test_an_impossible_shard_is_refused(run: Run, folder_to_merge: Path, text: str) -> None:
    result = run(*GRADE, folder_to_merge, "--shard", text)
    assert result.exit_code == 2
    assert "is not a shard such as 3/16" in " ".join(result.stderr.replace("│", " ").split())


def test_a_shard_is_json_lines(run: Run, folder_to_merge: Path) -> None:
    result = run(*GRADE[:-1], "csv", folder_to_merge, "--shard", "1/3")
    assert result.exit_code == 2
    assert "add --format jsonl" in result.stderr


def test_the_output_replaces_only_earlier_reports(
    run: Run, folder_to_merge: Path, tmp_path: Path
) -> None:
    files = shards(run, folder_to_merge, 2)
    target = tmp_path / "mine.jsonl"
    target.write_text("mine", encoding="utf-8")
    refused = run("merge", *files, "--output", target)
    assert (refused.exit_code, target.read_text(encoding="utf-8")) == (2, "mine")
    assert "no earlier report" in refused.stderr
    forced = run("merge", *files, "--output", target, "--force")
    again = run("merge", *files, "--output", target)
    assert forced.exit_code == again.exit_code
    assert "no earlier report" not in again.stderr
    shard = files[0].read_bytes()
    assert "would be overwritten" in run("merge", *files, "--output", files[0]).stderr
    assert files[0].read_bytes() == shard
