"""Ask two checkouts the same, and compare what comes back."""

import io
import json
import os
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any, Final

from tests.same.asked import Asked

_ANSWERING: Final = Path(__file__).with_name("answering.py")
# Characters of a difference that are printed.
_BEFORE, _AFTER = 60, 200


@dataclass(frozen=True)
class Difference:
    """What was asked, the name of what differs, and both values of it."""

    asked: Asked
    name: str
    base: str
    here: str


def compared(here: Path, commit: str, asked: Sequence[Asked]) -> list[Difference]:
    """Return every difference between a checkout and one of its commits."""
    with tempfile.TemporaryDirectory(prefix="same-") as name:
        folder = Path(name)
        base = folder / "base"
        unpack(here, commit, base)
        return differing(base, here, asked, folder)


def unpack(repository: Path, commit: str, folder: Path) -> None:
    """Write the files of a commit into a new folder."""
    # The checkout may belong to another user.
    command = ["git", "-c", f"safe.directory={repository}", "archive", commit]
    packed = subprocess.run(command, cwd=repository, capture_output=True, check=True).stdout
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        archive.extractall(folder, filter="data")


def differing(base: Path, here: Path, asked: Sequence[Asked], scratch: Path) -> list[Difference]:
    """Return every difference between two checkouts."""
    lines = scratch / "asked.jsonl"
    lines.write_text("".join(f"{each.line}\n" for each in asked), encoding="utf-8")
    answers = [scratch / "base.jsonl", scratch / "here.jsonl"]
    running = [
        subprocess.Popen(
            [sys.executable, str(_ANSWERING), str(lines), str(answer)],
            cwd=checkout,
            env={**os.environ, "PYTHONHASHSEED": "0", "DH_GRADER_LANGUAGE": "en"},
        )
        for checkout, answer in zip((base, here), answers, strict=True)
    ]
    codes = [each.wait() for each in running]
    if any(codes):
        raise RuntimeError("a checkout did not answer")
    return list(_differences(asked, *map(_answers, answers)))


def _answers(file: Path) -> Iterator[dict[str, Any]]:
    with file.open(encoding="utf-8") as lines:
        yield from map(json.loads, lines)


def _differences(
    asked: Sequence[Asked], base: Iterator[dict[str, Any]], here: Iterator[dict[str, Any]]
) -> Iterator[Difference]:
    for each, before, after in zip_longest(asked, base, here):
        for name in before.keys() | after.keys():
            if before.get(name) != after.get(name):
                yield Difference(each, name, _text(before.get(name)), _text(after.get(name)))


def _text(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def told(difference: Difference) -> str:
    """Return a difference in words, with the first place at which the values differ."""
    base, here = difference.base, difference.here
    pairs = enumerate(zip(base, here, strict=False))
    first = next((i for i, (one, other) in pairs if one != other), min(len(base), len(here)))
    start = max(0, first - _BEFORE)
    return (
        f"{difference.asked.name}: {difference.name}\n"
        f"  base: …{base[start : first + _AFTER]!r}\n"
        f"  here: …{here[start : first + _AFTER]!r}"
    )
