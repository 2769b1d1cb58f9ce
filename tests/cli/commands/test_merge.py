"""Test `grade --shard` and `merge`: several machines grade one class."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Run = Callable[..., Result]

RIGHT = "a, alpha, d, theta\n0, 0, 0, q1\nl1, 0, 0, q2\nl2, 0, 0, q3\nl3, 0, 0, 0\n"
GRADE = ("grade", "--exercise", "planar-rrr", "--part", "table", "--format", "jsonl")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
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
def test_merged_shards_are_the_same_as_one_run(run: Run, folder: Path, count: int) -> None:
    whole = run(*GRADE, folder)
    assert whole.exit_code == 2  # of the empty file
    assert len(whole.stdout.splitlines()) == 7
    merged = run("merge", *reversed(shards(run, folder, count)))
    assert merged.stdout == whole.stdout
    assert merged.exit_code == whole.exit_code


def test_the_exit_code_of_merge_is_that_of_the_worst_submission(run: Run, folder: Path) -> None:
    (folder / "gus.csv").unlink()
    assert run("merge", *shards(run, folder, 2)).exit_code == 1
    for file in folder.glob("*.csv"):
        file.write_text(RIGHT, encoding="utf-8")
    assert run("merge", *shards(run, folder, 2)).exit_code == 0


def test_each_submission_is_in_exactly_one_shard(run: Run, folder: Path) -> None:
    names = [
        [json.loads(line)["submission"] for line in file.read_text("utf-8").splitlines()[1:]]
        for file in shards(run, folder, 3)
    ]
    assert [len(each) for each in names] == [3, 2, 2]
    assert len({name for each in names for name in each}) == 7


def test_shards_that_do_not_fit_together_are_refused(run: Run, folder: Path) -> None:
    first, second, third = shards(run, folder, 3)
    output = folder.parent / "all.jsonl"

    def refused(*files: Path) -> str:
        result = run("merge", *files, "--output", output)
        assert result.exit_code == 2
        assert not output.exists()
        return result.stderr

    assert "Missing shards of 3: 2." in refused(first, third)
    assert "is shard 1, and so is" in refused(first, second, third, first)
    assert "is not a shard" in refused(first, folder / "ada.csv")
    assert "cannot be read" in refused(first, folder / "nobody.jsonl")
    lines = second.read_bytes()
    second.write_bytes(lines[: len(lines) // 2])
    assert f"{second} is incomplete" in refused(first, second, third)
    second.write_bytes(lines + lines.splitlines(keepends=True)[-1])
    assert f"{second} has more lines" in refused(first, second, third)
    (folder / "zoe.csv").write_text(RIGHT, encoding="utf-8")
    run(*GRADE, folder, "--shard", "2/3", "--output", second)
    assert "is from another run" in refused(first, second, third)


@pytest.mark.parametrize("text", ["0/3", "4/3", "3", "1/0", "-1/3", "1/1001", "１/3", "a/b"])
def test_an_impossible_shard_is_refused(run: Run, folder: Path, text: str) -> None:
    result = run(*GRADE, folder, "--shard", text)
    assert result.exit_code == 2
    assert "is not a shard such as 3/16" in " ".join(result.stderr.replace("│", " ").split())


def test_a_shard_is_json_lines(run: Run, folder: Path) -> None:
    result = run(*GRADE[:-1], "csv", folder, "--shard", "1/3")
    assert result.exit_code == 2
    assert "add --format jsonl" in result.stderr


def test_the_output_replaces_only_earlier_reports(run: Run, folder: Path, tmp_path: Path) -> None:
    files = shards(run, folder, 2)
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
