"""What is asked of both checkouts: requests over HTTP, and commands.

The answers come from everything that the tests know: the model answers and the wrong ones in
exercise files, each slip on each robot, valid tables in random frames, the corpora of pasted texts
and of formulas, and bodies that exhaust the work budget. Nothing here asks how a part of the
program works, so that the same requests can be sent to a version with other modules.
"""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice, product
from typing import Any, Final

import numpy as np
from dh_grader.catalogue import Exercise
from dh_grader.grading.misconception import all_records

from tests.docs import sentences
from tests.expressions.corpus_files import cases, repair_cases, repairs
from tests.frame_choice import misconceptions
from tests.frame_choice.generator import reassignment
from tests.frame_choice.robots import POLICIES, Robot, conventions
from tests.frame_choice.rows.student_rows import shipped_robots
from tests.grading.diagnosis.traces import answered, exercises
from tests.grading.reading.pasted_texts import languages, texts
from tests.worst.bodies import KNOWN

LEVELS: Final = ("full", "hints", "verdicts", "score")
LANGUAGES: Final = ("en", "de")
ALL_LANGUAGES: Final = ("en", "de", "es", "fr", "zh")
# The reports that are asked of the face of the package; all others go over HTTP.
BY_FACE: Final = ("full", "en")
FRAMES: Final = 20
# Changes of a right table, each on all cells where it makes sense.
SLIPS: Final = (
    misconceptions.wrong_sign, misconceptions.quarter_turn, misconceptions.half_turn,
    misconceptions.variable_missing, misconceptions.variable_sign, misconceptions.variable_doubled,
    misconceptions.variable_index, misconceptions.degrees_everywhere,
    misconceptions.columns_shifted, misconceptions.a_and_d_swapped,
    misconceptions.alpha_and_theta_swapped, misconceptions.rows_exchanged,
    misconceptions.column_signs,
)  # fmt: skip
# The places of messages that hints are asked for; None asks for a message on the whole part.
ROWS: Final = (None, "1", "2", "3", "e")
CELLS: Final = (None, "a", "alpha", "d", "theta")
LAZY: Final = ("0", "", "1", "q1", "0.785", "pi/2")


@dataclass(frozen=True)
class Asked:
    """A request or a command. ``name`` is unique, and says what it is about."""

    name: str
    # The words of a command; empty for a request.
    words: Sequence[str] = ()
    method: str = "GET"
    path: str = ""
    body: object = None
    # A program that has ``dh_grader.grade`` answers by it, another one by the request.
    by_face: bool = False
    # The contents of files, by their names, for a command.
    files: Mapping[str, str] = field(default_factory=dict)

    @property
    def line(self) -> str:
        """The request or command as a line of JSON."""
        return json.dumps(vars(self), ensure_ascii=False)


def all_asked() -> Iterator[Asked]:
    """Yield everything that is asked, in an order that does not change."""
    catalogue = exercises()
    yield from _reports(catalogue)
    yield from _hints()
    yield from _previews(catalogue)
    yield from _pages(catalogue)
    yield from _costly()
    yield from _commands(catalogue)


# --- Reports


def _reports(catalogue: Mapping[str, Exercise]) -> Iterator[Asked]:
    for i, (exercise, answers, unit) in enumerate(_answers(catalogue)):
        for level, language in product(LEVELS, LANGUAGES):
            body = {"answers": answers, "angle_unit": unit, "feedback": level, "echo": True}
            yield Asked(
                f"report {i} of {exercise}, {level}, {language}",
                method="POST",
                path=f"/v1/exercises/{exercise}/grade?lang={language}",
                body=body,
                by_face=(level, language) == BY_FACE,
            )


def _answers(catalogue: Mapping[str, Exercise]) -> Iterator[tuple[str, Any, str]]:
    for example in sentences.answers(catalogue):
        yield example.exercise, example.answers, example.angle_unit
    for name, part, text in _pasted(catalogue):
        yield name, {part: text}, "radians"
    for exercise in catalogue.values():
        for part, text in product(_tables(exercise), LAZY):
            yield exercise.id, {part: [[text] * 4] * len(exercise.joints)}, "radians"
    for robot in shipped_robots():
        part = _tables(catalogue[robot.name])[0]
        for rows in (*_slips(robot), *_other_frames(robot)):
            yield robot.name, {part: [list(row) for row in rows]}, "radians"


def _tables(exercise: Exercise) -> list[str]:
    return [part.id for part in exercise.parts if part.kind == "dh_table"]


def _slips(robot: Robot) -> Iterator[Sequence[Sequence[str]]]:
    yield robot.rows
    for slip in SLIPS:
        yield from slip(robot, robot.rows)


def _other_frames(robot: Robot) -> Iterator[Sequence[Sequence[str]]]:
    dice = np.random.default_rng(7)
    for policy in POLICIES:
        for convention in conventions(robot, policy):
            for _ in range(FRAMES // len(POLICIES)):
                table, _ = reassignment(robot, policy, convention, dice)
                yield table.texts


def _pasted(catalogue: Mapping[str, Exercise]) -> Iterator[tuple[str, str, str]]:
    parts = {"matrix": ("planar-rrr", "pose"), "position": ("planar-rr", "position")}
    for language in languages():
        for case in texts(language):
            yield *parts.get(case.kind, ("rrrp", "table")), case.text
    for text in sentences.pasted_texts():
        for part in ("table", "links", "pose"):
            yield "planar-rr", part, text


# --- Hints


def _hints() -> Iterator[Asked]:
    # Each step of the hint on the slip of a record, at each place that its example may name.
    for record in all_records():
        if record.example is None or not record.codes:
            continue
        exercise, part, answer, *_ = record.example
        given = {part: answered(exercise, part, answer)}
        for row, cell, step in product(ROWS, CELLS, (1, 2, 3)):
            place = {name: each for name, each in (("row", row), ("cell", cell)) if each}
            yield Asked(
                f"hint on {record.code} in {exercise}, {part}: {row}, {cell}, {step}",
                method="POST",
                path=f"/v1/exercises/{exercise}/hints",
                body={"answers": given, "part": part, "code": record.code, "step": step} | place,
            )


# --- Previews and frames


def _previews(catalogue: Mapping[str, Exercise]) -> Iterator[Asked]:
    for i, text in enumerate(_formulas()):
        for language in LANGUAGES:
            yield Asked(
                f"preview of formula {i}, {language}",
                method="POST",
                path=f"/v1/preview?lang={language}",
                body={"exercise": "stanford-arm", "part": "pose", "text": text},
            )
    for i, (exercise, part, text) in enumerate(_pasted(catalogue)):
        yield Asked(
            f"preview of pasted text {i}, {part}",
            method="POST",
            path="/v1/preview",
            body={"exercise": exercise, "part": part, "pasted": text},
        )
    for robot in shipped_robots():
        names = ("a", "alpha", "d", "theta")
        rows = [dict(zip(names, row, strict=True)) for row in robot.rows]
        table = {"rows": rows, "convention": robot.convention}
        for more in ({}, {"formulas": True}):
            yield Asked(
                f"frames of {robot.name}, {more}",
                method="POST",
                path="/v1/frames",
                body={"exercise": robot.name, "table": table | more},
            )


def _formulas() -> Iterator[str]:
    yield from sentences.formulas()
    for name in ("errors", "spellings", "texts"):
        with_cases = islice(_cases(name), 400)
        yield from (text for text in with_cases if isinstance(text, str))
    for name in repairs():
        yield from (case.text for case in repair_cases(name) if isinstance(case.text, str))


def _cases(name: str) -> Iterator[Any]:
    try:
        yield from (case.text for case in cases(name))
    except FileNotFoundError:
        return


# --- Pages, documents and pictures


def _pages(catalogue: Mapping[str, Exercise]) -> Iterator[Asked]:
    paths = ["/", "/help", "/practice", "/play", "/openapi.json", "/docs", "/v1/practice/next"]
    paths += ["/nothing/here", "/v1/exercises", "/v1/exercises/nothing", "/healthz", "/readyz"]
    for name in catalogue:
        paths += [f"/exercises/{name}", f"/v1/exercises/{name}", f"/v1/exercises/{name}/solution"]
    for path, language in product(paths, ALL_LANGUAGES):
        yield Asked(f"GET {path}, {language}", path=f"{path}?lang={language}")
    for name, theme in product(catalogue, ("light", "dark")):
        path = f"/v1/exercises/{name}/figure.svg?theme={theme}"
        yield Asked(f"GET {path}", path=path)


# --- Bodies that exhaust the work budget


def _costly() -> Iterator[Asked]:
    for name, attack in KNOWN.items():
        if attack.entry in ("grade", "hints", "solution", "attempts", "file"):
            yield Asked(
                f"costly: {name}",
                method="POST",
                path=f"/v1/exercises/{attack.exercise}/grade",
                body=attack.body,
            )


# --- Commands


COMMANDS: Final = (
    "", "serve", "exercises", "exercises list", "exercises show", "exercises new",
    "exercises check", "exercises import", "exercises export", "exercises deploy", "assignments",
    "grade", "merge", "attempts", "attempts list", "attempts export", "attempts regrade",
    "attempts forget", "courses", "courses list", "courses learners", "lti", "keys", "learners",
    "backup", "restore", "doctor", "bundle",
)  # fmt: skip
FORMATS: Final = (
    "text", "json", "jsonl", "csv", "gradebook", "markdown", "html", "junit", "gradescope",
    "prairielearn", "classroom50", "gitlab", "github",
)  # fmt: skip
_WRONG: Final = "a, alpha, d, theta\n0, 0, 0, q1\nl1, 0, 0, -q2\nl2, 90deg, 0, q3\nl3, 0, 0, 0\n"


def _commands(catalogue: Mapping[str, Exercise]) -> Iterator[Asked]:
    for command in COMMANDS:
        for language in LANGUAGES:
            words = [*command.split(), "--help"]
            yield Asked(f"help of {command or 'all'}, {language}", ["--lang", language, *words])
    for name in catalogue:
        yield Asked(f"exercises show {name}", ["exercises", "show", name])
    for name in FORMATS:
        words = ["grade", "anna.csv", "--exercise", "planar-rrr", "--part", "table"]
        yield Asked(f"grade, {name}", [*words, "--format", name], files={"anna.csv": _WRONG})


def share_of(asked: Iterable[Asked], share: int) -> Iterator[Asked]:
    """Yield one in ``share`` of all that is asked, the same ones each time."""
    return (each for i, each in enumerate(asked) if i % share == 0)
