"""Divide the submissions of a class between machines, and merge the results.

Shard 3 of 16 has the submissions 3, 19, 35, and so on.
"""

# The first line of a shard's file is a header that describes the division, so that merging notices
# a missing, incomplete or foreign file.

import hashlib
import json
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path
from typing import BinaryIO, Final, TypeVar

import typer

from service.regex import regex
from service.translations import say

_Item = TypeVar("_Item")

MOST_SHARDS: Final = 1000
# The longest header; a file of something else may have lines of any length.
_LONGEST_HEADER: Final = 1000
_FORM: Final = regex(r"([0-9]{1,4})/([0-9]{1,4})", re.ASCII)


class UnusableShardsError(ValueError):
    """The files are not all shards (parts) of the same run; the message says why."""


@dataclass(frozen=True, slots=True)
class Shard:
    """A shard: one of ``count`` subsets of the submissions, numbered from 1."""

    number: int
    count: int

    def of(self, items: Sequence[_Item]) -> list[_Item]:
        """Return the items that belong to this shard."""
        return list(items[self.number - 1 :: self.count])


def shard_of(text: str) -> Shard:
    """Parse a shard such as ``3/16``, the third of 16 subsets of the submissions.

    Raises typer.BadParameter.
    """
    found = _FORM.fullmatch(text)
    shard = Shard(int(found[1]), int(found[2])) if found else Shard(0, 0)
    if not 1 <= shard.number <= shard.count <= MOST_SHARDS:
        raise typer.BadParameter(
            f"{text!r} is not a shard such as 3/16: a number from 1 to the count of shards, which "
            f"is at most {MOST_SHARDS}."
        )
    return shard


@dataclass(frozen=True, slots=True)
class ShardHeader:
    """The first line of a file with the results of one shard (subset of the submissions).

    ``exercises`` is the number of lines for each submission. ``run`` is a hash of the names of all
    submissions and exercises.
    """

    shard: int
    shards: int
    submissions: int
    exercises: int
    run: str


def with_header(
    lines: Iterable[bytes], shard: Shard, submissions: Sequence[str], exercises: Sequence[str]
) -> Iterator[bytes]:
    """Yield the header of a shard's file, then the lines.

    ``submissions`` and ``exercises`` are all names in the run, not only in this shard.
    """
    names = json.dumps([submissions, exercises])
    run = hashlib.sha256(names.encode()).hexdigest()
    header = ShardHeader(shard.number, shard.count, len(submissions), len(exercises), run)
    yield json.dumps(asdict(header)).encode() + b"\n"
    yield from lines


def merged(files: Sequence[Path]) -> Iterator[bytes]:
    """Yield the lines of a whole run from the files of its shards.

    Raises UnusableShardsError.
    """
    with ExitStack() as opened:
        shards: dict[int, tuple[ShardHeader, Path, BinaryIO]] = {}
        for path in files:
            file = opened.enter_context(_opened(path))
            header = _header(file.readline(_LONGEST_HEADER), path)
            if header.shard in shards:
                raise UnusableShardsError(
                    say(
                        "{path}: is shard {shard}, and so is {other}",
                        path=str(path),
                        shard=header.shard,
                        other=str(shards[header.shard][1]),
                    )
                )
            shards[header.shard] = header, path, file
        _require_one_run(shards)
        in_order = [shards[number] for number in sorted(shards)]
        first = in_order[0][0]
        for i in range(first.submissions):
            _, path, file = in_order[i % first.shards]
            yield from islice(_whole_lines(file, path), first.exercises)
        for _, path, file in in_order:
            if file.read(1):
                raise UnusableShardsError(
                    say("{path}: has more lines than its header says", path=str(path))
                )


def _opened(path: Path) -> BinaryIO:
    try:
        return path.open("rb")
    except OSError as error:
        raise UnusableShardsError(
            say("{path}: cannot be read: {reason}", path=str(path), reason=str(error.strerror))
        ) from error


def _header(line: bytes, path: Path) -> ShardHeader:
    try:
        header = ShardHeader(**json.loads(line))
        shard_of(f"{header.shard}/{header.shards}")
    except (ValueError, TypeError, typer.BadParameter):
        raise UnusableShardsError(
            say("{path}: is not a shard; dh-grader grade --shard writes shards", path=str(path))
        ) from None
    return header


def _require_one_run(shards: dict[int, tuple[ShardHeader, Path, BinaryIO]]) -> None:
    first, first_path, _ = next(iter(shards.values()))
    for header, path, _ in shards.values():
        same = (header.shards, header.submissions, header.exercises, header.run)
        if same != (first.shards, first.submissions, first.exercises, first.run):
            raise UnusableShardsError(
                say(
                    "{path}: is from another run than {first_path}: the submissions, the "
                    "assignment or the count of shards differ",
                    path=str(path),
                    first_path=str(first_path),
                )
            )
    missing = [number for number in range(1, first.shards + 1) if number not in shards]
    if missing:
        numbers = ", ".join(map(str, missing))
        raise UnusableShardsError(
            say("Missing shards of {count}: {numbers}.", count=first.shards, numbers=numbers)
        )


def _whole_lines(file: BinaryIO, path: Path) -> Iterator[bytes]:
    while True:
        line = file.readline()
        if not line.endswith(b"\n"):
            raise UnusableShardsError(
                say("{path}: is incomplete; grade this shard again", path=str(path))
            )
        yield line
