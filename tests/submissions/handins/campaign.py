"""Make classes of hand-ins, grade them by the command line, and compare each with its answer."""

import csv
import io
import json
import os
import subprocess
import sys
import zipfile
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from tests.submissions.handins.answers import (
    PARTS,
    Answer,
    Graded,
    expected,
    right,
    verdicts_of,
    wrong,
)
from tests.submissions.handins.files import KINDS, Kind, Made
from tests.submissions.handins.libreoffice import converted, is_installed
from tests.submissions.handins.platforms import PLATFORMS, Student

ROOT: Final = Path(__file__).parents[3]
# Students in a class.
_CLASS: Final = 25
# The results of a hand-in. "listed" is left to a person, and has no points; "cells" has points, and
# the report names cells that could not be read.
RESULTS: Final = ("right", "listed", "cells", "misread", "counted 0")
_SHARE_OF_WRONG: Final = 0.45
_OWN_NAMES: Final = (
    "table", "homework3", "HW 3 final (2)", "DH_Tabelle_Müller", "my.answer.v2", "Übung 3", "dh-1",
)  # fmt: skip


@dataclass(frozen=True)
class HandIn:
    """A file with the answer to a part, and what it must earn."""

    kind: Kind
    answer: Answer
    made: Made


@dataclass(frozen=True)
class Outcome:
    """The result of one file: which of RESULTS it is, and what the report says."""

    kind: Kind
    result: str
    where: str
    said: str


@dataclass(frozen=True)
class SchoolClass:
    """The hand-ins of a class by student. With ``part``, the command grades only this part."""

    exercise: str
    part: str | None
    platform: str
    is_zip: bool
    hand_ins: Sequence[Sequence[HandIn]]

    @property
    def name(self) -> str:
        """The name of the folder of the class."""
        return f"{self.exercise} {self.part or 'whole'} {self.platform}".replace(", ", " ")


def kinds(*, with_libreoffice: bool = True) -> list[Kind]:
    """Return the kinds that the programs on this machine can write."""
    return [
        kind
        for kind in KINDS
        if not kind.by_libreoffice or (with_libreoffice and is_installed(kind.by_libreoffice))
    ]


def drawn(
    count: int,
    seed: int,
    folder: Path,
    *,
    class_size: int = _CLASS,
    with_libreoffice: bool = True,
) -> list[SchoolClass]:
    """Return classes with ``count`` files, each kind in turn, made in ``folder``."""
    known = kinds(with_libreoffice=with_libreoffice)
    rng = np.random.default_rng(seed)
    # A class gets different kinds, and each sample of a campaign others.
    places = [*rng.permutation(count)]
    waiting = [known[(place + seed) % len(known)] for place in places]
    exercises = [(name, part) for name, parts in PARTS.items() for part in (*parts, None)]
    exercises = [each for each in exercises if each[1] or len(PARTS[each[0]]) > 1]
    order = rng.permutation(len(exercises))
    classes = []
    for k, start in enumerate(range(0, count, class_size)):
        exercise, part = exercises[order[k % len(exercises)]]
        platform = list(PLATFORMS)[(k + seed) % len(PLATFORMS)]
        own = waiting[start : start + class_size]
        hand_ins = list(_hand_ins(exercise, part, own, rng))
        is_zip = (k + seed) % 2 == 0
        classes.append(SchoolClass(exercise, part, platform, is_zip, hand_ins))
    return _with_conversions(classes, folder)


def _hand_ins(
    exercise: str, part: str | None, own: Iterable[Kind], rng: np.random.Generator
) -> Iterator[list[HandIn]]:
    # Without a part, each student answers one or two parts, in a file each.
    waiting = list(own)
    while waiting:
        parts = PARTS[exercise] if part is None else (part,)
        found = []
        for each in parts:
            if waiting:
                kind = waiting.pop()
                is_wrong = rng.random() < _SHARE_OF_WRONG
                answer = wrong(exercise, each, rng) if is_wrong else right(exercise, each)
                found.append(HandIn(kind, answer, kind.make(answer, rng)))
        yield found


def _with_conversions(classes: Sequence[SchoolClass], folder: Path) -> list[SchoolClass]:
    flat = [hand_in for each in classes for student in each.hand_ins for hand_in in student]
    sources = {i: hand_in.made for i, hand_in in enumerate(flat) if hand_in.made.target}
    files = converted(sources, folder / "libreoffice") if sources else {}
    numbers = iter(range(len(flat)))
    return [
        replace(
            each,
            hand_ins=[
                [replace(it, made=files.get(next(numbers), it.made)) for it in student]
                for student in each.hand_ins
            ],
        )
        for each in classes
    ]


def _students(school_class: SchoolClass) -> list[Student]:
    students = []
    for number, hand_ins in enumerate(school_class.hand_ins):
        files: dict[str, bytes] = {}
        text = None
        for i, hand_in in enumerate(hand_ins):
            if hand_in.kind.is_editor and school_class.part is not None:
                text = hand_in.made.content
                continue
            stem = _OWN_NAMES[(number + i) % len(_OWN_NAMES)]
            if school_class.part is None:
                stem = hand_in.answer.part
            ending = hand_in.made.ending
            files[f"{stem}{ending.upper() if number % 9 == 4 else ending}"] = hand_in.made.content
        students.append(Student(number, files, text))
    return students


def _written(school_class: SchoolClass, students: Sequence[Student], folder: Path) -> Path:
    platform = PLATFORMS[school_class.platform]
    files = {name: data for each in students for name, data in platform.files(each).items()}
    files |= platform.others
    path = folder / school_class.name
    if school_class.is_zip:
        path = path.with_name(f"{path.name}.zip")
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in files.items():
                archive.writestr(name, content)
        return path
    for name, content in files.items():
        file = path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
    return path


def _command(path: Path, school_class: SchoolClass, output_format: str) -> bytes:
    command = [
        sys.executable, "-m", "dh_grader", "grade", str(path), "--exercise", school_class.exercise,
        "--format", output_format, "--jobs", "1",
    ]  # fmt: skip
    if school_class.part is not None:
        command += ["--part", school_class.part]
    done = subprocess.run(
        command, cwd=ROOT, env=os.environ | {"DH_GRADER_LANGUAGE": "en"}, capture_output=True,
        check=False,
    )  # fmt: skip
    assert done.returncode in (0, 1, 2), done.stderr
    return done.stdout


def outcomes(school_class: SchoolClass, folder: Path) -> list[Outcome]:
    """Grade a class by the command line; return the result of each file."""
    students = _students(school_class)
    path = _written(school_class, students, folder)
    entries = json.loads(_command(path, school_class, "json"))
    grades = list(csv.DictReader(io.StringIO(_command(path, school_class, "gradebook").decode())))
    assert len(entries) == len(grades)
    platform = PLATFORMS[school_class.platform]
    by_learner = {
        row["Identifier"]: (entry, row["Grade"]) for entry, row in zip(entries, grades, strict=True)
    }
    assert len(by_learner) == len(grades), "two submissions have one learner"
    found = []
    for student, hand_ins in zip(students, school_class.hand_ins, strict=True):
        learner = platform.learner(student)
        where = f"{path.name}: {learner}: {', '.join(student.files) or 'text'}"
        if learner not in by_learner:
            found += [Outcome(it.kind, "counted 0", where, "no such learner") for it in hand_ins]
            continue
        found += _judged(hand_ins, *by_learner.pop(learner), where)
    # A file of the platform that is no submission must not become a student with points.
    found += [
        Outcome(KINDS[0], "misread", f"{path.name}: {learner}", "a learner without a hand-in")
        for learner, (_, grade) in by_learner.items()
        if grade
    ]
    return found


def _judged(
    hand_ins: Sequence[HandIn], entry: Mapping[str, Any], grade: str, where: str
) -> Iterator[Outcome]:
    parts = {part["part"]: part for part in entry.get("report", {}).get("parts", ())}
    read = [hand_in.answer for hand_in in hand_ins if hand_in.kind.is_read]
    wanted = expected(read) if read else {}
    for hand_in in hand_ins:
        answer = hand_in.answer
        part = parts.get(answer.part)
        result = _result(hand_in, part, wanted.get(answer.part), grade)
        said = [entry.get("error", ""), _said(part, wanted.get(answer.part))]
        place = f"{where}: {answer.part}, {answer.slip or 'right'}"
        yield Outcome(hand_in.kind, result, place, " | ".join(filter(None, said)))


def _said(part: Mapping[str, Any] | None, wanted: Graded | None) -> str:
    if part is None:
        return "no report"
    messages = [f"{message['code']}: {message['message']}" for message in part["feedback"]]
    for row in part["rows"]:
        messages += [f"row {row['label']}: {message['code']}" for message in row["feedback"]]
        messages += [
            f"row {row['label']}, {cell['label']}: {message['code']}: {message['message']}"
            for cell in row["cells"]
            for message in cell["feedback"]
        ]
    points = f"{part['verdict']}, {part['points']} points instead of {wanted and wanted.points}"
    return " | ".join([points, *messages[:5]])


def _result(
    hand_in: HandIn, part: Mapping[str, Any] | None, wanted: Graded | None, grade: str
) -> str:
    if not hand_in.kind.is_read:
        return "listed" if not grade else "counted 0"
    assert wanted is not None
    if part is not None and part["verdict"] not in ("unreadable", "missing"):
        verdicts = verdicts_of(part)
        if part["points"] == wanted.points and verdicts == wanted.verdicts:
            return "right"
        return "cells" if "unreadable" in verdicts else "misread"
    return "listed" if not grade else "counted 0"


def table_of(found: Sequence[Outcome]) -> str:
    """Return a table of the results by kind."""
    counts = Counter((each.kind.name, each.result) for each in found)
    lines = [f"{'kind':36}{'made':>6}" + "".join(f"{name:>11}" for name in RESULTS)]
    lines += [_line(kind.name, counts, [kind.name]) for kind in KINDS]
    for name, chosen in (
        ("all that are read", [it.name for it in KINDS if it.is_read and not it.is_apart]),
        ("all that are not read", [it.name for it in KINDS if not it.is_read]),
    ):
        lines.append(_line(name, counts, chosen))
    return "\n".join(lines)


def _line(title: str, counts: Counter[tuple[str, str]], names: Sequence[str]) -> str:
    own = [sum(counts[name, result] for name in names) for result in RESULTS]
    return f"{title:36}{sum(own):>6}" + "".join(f"{count:>11}" for count in own)


def share_right(found: Sequence[Outcome]) -> float:
    """Return the share of files graded right, of the kinds that are read."""
    read = [each for each in found if each.kind.is_read and not each.kind.is_apart]
    return sum(each.result == "right" for each in read) / len(read)


def faults(found: Sequence[Outcome]) -> list[Outcome]:
    """Return the files that are misread, or that count as 0 though nobody read them."""
    return [
        each for each in found if each.result in ("misread", "counted 0") and not each.kind.is_apart
    ]
