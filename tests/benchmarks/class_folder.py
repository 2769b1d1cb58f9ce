"""Write a folder with the submissions of a class, of which a few are broken.

``python -m tests.benchmarks.class_folder --count 1000`` grades such a folder, and
prints the time and the memory.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.benchmarks import answers
from tests.benchmarks.timing import floor_seconds

EXERCISE = "stanford-arm"
# In this time 1,000 submissions are graded on two cores.
SECONDS = 15.0

# The names of unusable submissions, and a word of the reason for each.
BROKEN = {
    "a-empty.json": "is empty",
    "b-unreadable.json": "line 1",
    "c-binary.json": "zero bytes",
    "d-large.json": "larger than 256 KiB",
    "e-word.docx": "is damaged, or not what its name says",
    "f-pipe.json": "pipe",
    "g-link.json": "symbolic link out of the folder",
    "h-nothing": "holds no file",
    "i-folder.json": "holds no file",
}


def write_class(folder: Path, count: int) -> None:
    folder.mkdir()
    (folder.parent / "secret.json").write_text('{"answers": {}}', encoding="utf-8")
    for i in range(count):
        _write_student(folder, i)
    (folder / "a-empty.json").touch()
    (folder / "b-unreadable.json").write_text("{answers}", encoding="utf-8")
    (folder / "c-binary.json").write_bytes(bytes(range(256)) * 40)
    (folder / "d-large.json").write_bytes(b'{"answers": {"table": "' + b"1," * 2_500_000 + b'"}}')
    (folder / "e-word.docx").write_bytes(b"PK\x03\x04\x00\x00" * 100)
    os.mkfifo(folder / "f-pipe.json")
    (folder / "g-link.json").symlink_to("../secret.json")
    (folder / "h-nothing").mkdir()
    (folder / "i-folder.json").mkdir()


def _write_student(folder: Path, i: int) -> None:
    rows = answers.one_student_s_table(i)
    pose = answers.distinct(answers.T06 if i % 5 else answers.standing_still(), i)
    body = {"answers": {"table": answers.table(rows), "pose": pose}}
    match i % 4:
        case 0:
            file = folder / f"student{i:04}.json"
        case 1:
            file = folder / f"Ada Byron{i}_{i}_assignsubmission_file_" / "answer.json"
        case 2:
            file = folder / f"byronada{i}_{1000 + i}_{5000 + i}_hand-in.json"
        case _:
            clone = folder / f"homework-student{i}"
            (clone / ".git").mkdir(parents=True)
            (clone / "README.md").write_text("# Homework", encoding="utf-8")
            lines = ["a, alpha, d, theta", *(", ".join(row) for row in rows)]
            (clone / "table.csv").write_text("\n".join(lines), encoding="utf-8")
            (clone / "pose.txt").write_text(
                "\n".join("; ".join(row) for row in pose), encoding="utf-8"
            )
            return
    file.parent.mkdir(exist_ok=True)
    file.write_text(json.dumps(body), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--format", default="json")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "class"
        write_class(folder, options.count)
        subprocess.run(
            [
                sys.executable, "-m", "dh_grader", "grade", str(folder), "--exercise", EXERCISE,
                "--format", options.format, "--output", str(Path(temporary) / "out"),
                "--jobs", str(options.jobs),
            ],
            stderr=subprocess.DEVNULL, check=False,
        )  # fmt: skip
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = (used.ru_utime + used.ru_stime) / options.jobs
    verdict = "met" if seconds <= SECONDS else "missed"
    print(f"{options.count} submissions: {seconds:.1f} s of processor time on each core")
    print(f"asked: {SECONDS:g} s for 1,000, {verdict}; at most {used.ru_maxrss / 1024:.0f} MB each")
    print(f"the plain-numpy floor took {floor_seconds() * 1e3:.3f} ms here")


if __name__ == "__main__":
    main()
