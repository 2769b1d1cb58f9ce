"""A thief, who asks for reports until they give the answer away."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from typing import Any

from dh_grader.catalogue import Exercise, FeedbackLevel, PartSpec
from dh_grader.catalogue.kinds import FindSlipSpec
from dh_grader.expressions import ExpressionError, Vocabulary, read
from dh_grader.grading import PartReport, Submission, Verdict, grade, report_on_part
from dh_grader.grading.kinds.tables import slip_of
from dh_grader.grading.report import messages_of
from dh_grader.hints import STEPS, Topic, hint_step

from tests.grading.support.robots import COLUMNS

# --- Convert an answer to a grid of texts, and back

Grid = list[list[str]]


@dataclass(frozen=True)
class Sheet:
    """The labels and the shape of an answer that is written as a grid."""

    # `marked` are the cells with the slip, if the part asks for a slip; every posted answer marks
    # them.
    kind: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    marked: tuple[str, ...] = ()

    def filled(self, text: str) -> Grid:
        return [[text] * len(self.columns) for _ in self.rows]

    def posted(self, grid: Sequence[Sequence[str]]) -> Any:
        if self.kind in ("dh_table", "dh_row"):
            rows = [dict(zip(COLUMNS, row, strict=True)) for row in grid]
            return {"rows": rows} if self.kind == "dh_table" else rows[0]
        if self.kind == "find_slip":
            rows = [dict(zip(COLUMNS, row, strict=True)) for row in grid]
            return {"marked": list(self.marked), "table": {"rows": rows}}
        if self.kind == "link_transforms":
            return [list(map(list, grid[i : i + 4])) for i in range(0, len(grid), 4)]
        if self.kind == "frames":
            rows = [dict(zip(self.columns, row, strict=True)) for row in grid]
            return [{"frame": label, **row} for label, row in zip(self.rows, rows, strict=True)]
        if len(self.columns) == 1:
            return [row[0] for row in grid]
        return list(map(list, grid))

    def grid_of(self, answer: Any) -> Grid:
        if self.kind == "find_slip":
            answer = answer["table"]
        if self.kind in ("dh_table", "find_slip"):
            answer = answer["rows"]
        if self.kind == "dh_row":
            answer = [answer]
        if self.kind == "link_transforms":
            answer = [row for matrix in answer for row in matrix]
        if self.kind in ("dh_table", "dh_row", "find_slip"):
            return [[str(row[column]) for column in COLUMNS] for row in answer]
        if self.kind == "frames":
            answer = [[row["axis"], row["z"], *row["origin"], row["x"]] for row in answer]
        rows = [row if isinstance(row, list) else [row] for row in answer]
        return [list(map(str, row)) for row in rows]


def sheet_of(part: PartSpec, exercise: Exercise) -> Sheet:
    shape = dict(part.shape(exercise.reference))
    rows = tuple(shape.get("rows") or ("1",))
    if "matrices" in shape:
        rows = tuple(f"{matrix}.{row}" for matrix in shape["matrices"] for row in rows)
    marked: tuple[str, ...] = ()
    if isinstance(part, FindSlipSpec):
        cells = sorted(slip_of(part, exercise).cells)
        marked = tuple(f"{rows[i]}.{COLUMNS[j]}" for i, j in cells)
    return Sheet(part.kind, rows, tuple(shape.get("columns") or ("1",)), marked)


# --- Simulate a student who copies values from a report into the wrong cells

ROUNDS = 10
# The most words of a message that form one formula, such as theta1 + pi / 2.
WORDS = 5
_SAYING = ("message", "suggestion", "text", "latex")


def said(report: PartReport) -> Iterator[str]:
    def visit(value: Any, key: str) -> Iterator[str]:
        if isinstance(value, dict):
            for name, inner in value.items():
                if key == "values":
                    yield from (name, str(inner))
                else:
                    yield from visit(inner, name)
        elif isinstance(value, list | tuple):
            for inner in value:
                yield from visit(inner, key)
        elif key in _SAYING and isinstance(value, str):
            yield value

    data = asdict(report)
    yield from visit([data["feedback"], [row["feedback"] for row in data["rows"]]], "")
    yield from visit([cell["feedback"] for row in data["rows"] for cell in row["cells"]], "")


@lru_cache(maxsize=4096)
def expressions_in(text: str, vocabulary: Vocabulary) -> tuple[str, ...]:
    found: dict[str, None] = {}
    for words in (text.split(), re.sub(r"[()]", " ", text).split()):
        plain = [word.strip(".,;:?!`") for word in words]
        for i in range(len(plain)):
            for j in range(i + 1, min(i + WORDS, len(plain)) + 1):
                tried = " ".join(plain[i:j]).strip()
                # Several names in sequence are prose, unless an operator joins them.
                joined = j == i + 1 or re.search(r"[-+*/^0-9]", tried)
                if tried and joined and _reads(tried, vocabulary):
                    found[tried] = None
    return tuple(found)


def _reads(text: str, vocabulary: Vocabulary) -> bool:
    try:
        read(text, vocabulary, repairs=False)
    except ExpressionError:
        return False
    return True


def is_trivial(text: str) -> bool:
    return re.fullmatch(r"-?[01](\.0*)?", text) is not None


def shortened(text: str) -> str:
    return re.sub(r"\.0*$", "", text)


@dataclass
class Thief:
    """A student who copies values from reports into the wrong cells."""

    # `known` are the texts that the thief knows without a report. The trivial values 0, 1 and -1,
    # which are in most cells of every answer, do not count as stolen either. `hints` collects all
    # hints.
    exercise: Exercise
    part: PartSpec
    level: FeedbackLevel
    grid: Grid
    known: set[str]
    with_hints: bool = False
    tried: int = 0
    stolen: list[str] = field(default_factory=list)
    hints: set[str] = field(default_factory=set)

    @property
    def sheet(self) -> Sheet:
        return sheet_of(self.part, self.exercise)

    def report(self, grid: Grid) -> PartReport:
        answers = {self.part.id: self.sheet.posted(grid)}
        self.tried += 1
        report = grade(self.exercise, Submission(answers, feedback=self.level))
        return next(part for part in report.parts if part.part == self.part.id)

    def _hints(self, report: PartReport) -> Iterator[str]:
        if not self.with_hints:
            return
        answers = {self.part.id: self.sheet.posted(self.grid)}
        submission = Submission(answers, feedback=self.level)
        told = report_on_part(self.exercise, submission, self.part.id)
        for message, places, _ in messages_of(report):
            for place in places or (None,):
                at = (place.row, place.cell) if place else (None, None)
                topic = Topic(self.part.id, message.code, *at)
                for step in range(1, STEPS + 1):
                    hint = hint_step(self.exercise, topic, step, answers, told)
                    if hint is not None:
                        self.hints.add(hint.text)
                        yield from (hint.title, hint.text)

    def steal(self) -> tuple[float, float]:
        report = self.report(self.grid)
        first = report.points
        for _ in range(ROUNDS):
            before = worth(report)
            found = [
                text
                for saying in dict.fromkeys((*said(report), *self._hints(report)))
                for text in expressions_in(saying, self.exercise.vocabulary)
                if not is_trivial(text) and shortened(text) not in self.known
            ]
            for text in dict.fromkeys(found):
                report = self._copied(text, report)
            if worth(report) == before:
                break
        return first, report.points

    def _copied(self, text: str, report: PartReport) -> PartReport:
        everywhere = [
            [own if self._is_right(report, i, j) else text for j, own in enumerate(row)]
            for i, row in enumerate(self.grid)
        ]
        trial = self.report(everywhere)
        if trial.rows:
            helped = [
                [new if self._is_right(trial, i, j) else own for j, (own, new) in enumerate(pairs)]
                for i, pairs in enumerate(map(zip, self.grid, everywhere))
            ]
            report = self._kept(helped, text, report)
        # If frames are free, or cells have no verdicts, compare the points cell by cell.
        for i, row in enumerate(self.grid):
            for j in range(len(row)):
                if not self._is_right(report, i, j):
                    alone = [list(other) for other in self.grid]
                    alone[i][j] = text
                    report = self._kept(alone, text, report)
        return report

    def _kept(self, grid: Grid, text: str, report: PartReport) -> PartReport:
        if grid == self.grid:
            return report
        trial = self.report(grid)
        if worth(trial) <= worth(report):
            return report
        self.grid = grid
        self.stolen.append(text)
        return trial

    def _is_right(self, report: PartReport, i: int, j: int) -> bool:
        by_label = {row.label: row for row in report.rows}
        row = by_label.get(self.sheet.rows[i])
        return row is not None and j < len(row.cells) and row.cells[j].verdict is Verdict.CORRECT


def worth(report: PartReport) -> tuple[float, int]:
    cells = [cell.verdict for row in report.rows for cell in row.cells]
    return report.points, cells.count(Verdict.CORRECT)


def known_before(sheet: Sheet, grid: Grid) -> set[str]:
    labels = {piece for label in (*sheet.rows, *sheet.columns) for piece in label.split(".")}
    return {*labels, *(cell for row in grid for cell in row)}


def thief(exercise: Exercise, part: PartSpec, level: FeedbackLevel, grid: Grid) -> Thief:
    sheet = sheet_of(part, exercise)
    return Thief(exercise, part, level, grid, known_before(sheet, grid))


def lazy(exercise: Exercise, part: PartSpec) -> Grid:
    sheet = sheet_of(part, exercise)
    grid = sheet.filled("0")
    if part.kind == "dh_table":
        for row, joint in zip(grid, exercise.joints, strict=False):
            row[2 if joint.prismatic else 3] = joint.variable
    elif len(sheet.columns) in (3, 4) and part.kind != "dh_row":
        for i, row in enumerate(grid):
            row[i % len(sheet.columns)] = "1"
    return grid
