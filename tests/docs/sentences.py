"""Write docs/sentences.md: all sentences of messages, each with an example.

Run ``python -m tests.docs.sentences > docs/sentences.md``.
"""

# The examples come from the records
# of misconceptions, docs/messages.md, `sentence_examples.toml`, the checks in the exercise files,
# and the corpus of formulas. Each example is graded. The page shows each sentence with the first
# example that causes the sentence.

import re
import sys
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

from dh_grader.api.frames import GENERIC
from dh_grader.catalogue import Exercise
from dh_grader.expressions import LIMITS, AngleUnit, ExpressionError, Vocabulary, read
from dh_grader.grading import FeedbackLevel, Submission, grade
from dh_grader.grading.misconception import all_records
from dh_grader.grading.reading import preview_pasted
from dh_grader.grading.report import Feedback, PartReport, Place, messages_of, without_places

from tests.docs import test_message_codes as messages_page
from tests.docs.codes import sources
from tests.docs.templates import Template, templates_in
from tests.expressions.corpus_files import ROBOT, cases, repair_cases, repairs
from tests.grading.diagnosis.traces import END, answered, exercises

ROOT: Final = Path(__file__).parents[2]
EXAMPLES: Final = Path(__file__).with_name("sentence_examples.toml")
_READING: Final = ("expressions/", "pasting/", "grading/")
# Strings of two words that are not part of a message, or only of one for programmers.
_NO_SENTENCES: Final = frozenset(
    {
        "CSV with semicolons", "rows with semicolons", "drawn matrix", "Judged | None",
        "GivenMotion | None", "Reread | None", "end effector", "joint variable", "not applicable",
        "grids as written", "theta offset", "see above", "turns in steps", "efector final",
        "exercise … has no part …; it has …", "exercise … has no part …", "exercise … has no robot",
        "part … has no formulas",
        "Write a number or a formula, not true or false.",
    }
)  # fmt: skip
_LONGEST: Final = 240
_SECTION: Final = re.compile(r"^(?=# --- )", re.MULTILINE)


@dataclass(frozen=True)
class Said:
    """A message that an example answer causes."""

    code: str
    sentence: str
    correction: str
    where: str
    answer: str


@dataclass(frozen=True)
class Example:
    """Example answers to parts of an exercise."""

    exercise: str
    answers: Mapping[str, Any]
    angle_unit: AngleUnit = "radians"


# --- the examples


def formulas() -> Iterator[str]:
    """Yield example formulas."""
    for line in messages_page.LINES:
        if line.section in (messages_page.UNREAD, messages_page.NOTED) and line.example:
            yield line.example[0]
    yield from _written()["formulas"]
    for name in repairs():
        yield from (case.text for case in repair_cases(name) if isinstance(case.text, str))
    yield from (case.text for case in cases("errors"))


def pasted_texts() -> Iterator[str]:
    """Yield example tables and matrices to paste."""
    sections = (messages_page.PASTED_UNREAD, messages_page.PASTED_NOTED)
    for line in messages_page.LINES:
        if line.section in sections and line.example:
            yield line.example[0].replace(END, "\n")
    for text in _written()["pasted"]:
        yield text if isinstance(text, str) else text["text"] * text["times"]


def answers(catalogue: Mapping[str, Exercise]) -> Iterator[Example]:
    for record in all_records():
        if record.example is not None:
            name, part, answer, *unit = record.example
            given = {part: answered(name, part, answer)}
            yield Example(name, given, "degrees" if unit else "radians")
    for each in _written()["answers"]:
        unit = each.get("angle_unit", "radians")
        given = each["answers"] if "answers" in each else {each["part"]: each["answer"]}
        yield Example(each["exercise"], given, unit)
    for exercise in catalogue.values():
        for check in exercise.checks:
            yield Example(exercise.id, check.answers, check.angle_unit)
    # An answer that is too long to be read completely.
    yield Example("planar-rr", {"position": ["+" * LIMITS.characters] * 2})
    # Pasted texts that are too long together, or have too many brackets.
    for texts in (("q1 + " * 300 + "1, 2\n") * 12, ("(1)" * 180 + ", 2\n") * 12):
        yield Example("planar-rr", {"table": texts, "pose": "4" + texts})
    # An answer with too many mistakes to explain them all.
    wrong = [["c1 c4", "c1 s4", "c4 s1", "s1 s4"]] * 4
    yield Example("stanford-arm", {"table": wrong[:1] * 6, "links": [wrong] * 6, "pose": wrong})


def _written() -> dict[str, Any]:
    written: dict[str, Any] = tomllib.loads(EXAMPLES.read_text("utf-8").replace(END, "\\n"))
    return written


# --- the messages of the examples


def said_of_formulas(texts: Iterable[str], vocabulary: Vocabulary = ROBOT) -> Iterator[Said]:
    for text in texts:
        try:
            found = [(note.code, note.message, "") for note in read(text, vocabulary).notes]
        except ExpressionError as error:
            found = [(error.code, error.message, error.suggestion or "")]
        for code, sentence, suggestion in found:
            yield Said(code, sentence, suggestion, "", text)


def said_of_pasted(texts: Iterable[str], exercise: Exercise) -> Iterator[Said]:
    for text in texts:
        for part in ("table", "links", "pose"):
            preview = preview_pasted(text, exercise, part)
            found = [(note.code, note.message) for note in preview.notes]
            if preview.problem:
                found.append((preview.problem.code, preview.problem.message))
            for code, sentence in found:
                yield Said(code, sentence, "", f"{exercise.id}, {part}", text)


def said_of_answers(
    examples: Iterable[Example], catalogue: Mapping[str, Exercise]
) -> Iterator[Said]:
    """Yield the messages on each answer."""
    for example in examples:
        submission = Submission(example.answers, example.angle_unit, FeedbackLevel.FULL)
        unit = ", in degrees" if example.angle_unit == "degrees" else ""
        for part in grade(catalogue[example.exercise], submission).parts:
            for message, places, _ in messages_of(part):
                yield Said(
                    message.code,
                    message.message,
                    _correction(message),
                    f"{example.exercise}, {part.part}{unit}{_place(places)}",
                    shown(example.answers[part.part]),
                )
            yield from _said_of_points(part, example)


def _said_of_points(part: PartReport, example: Example) -> Iterator[Said]:
    where = f"{example.exercise}, {part.part}"
    answer = shown(example.answers.get(part.part, ""))
    # The second is the form of the level ``score``.
    for lost in (*part.lost, *without_places(part.lost)):
        yield Said(lost.code, lost.message, "", where, answer)
    if part.little_worth:
        yield Said("little_worth", part.little_worth.message, "", where, answer)


def _correction(message: Feedback) -> str:
    given = [message.correction, *(place.correction for place in message.places or ())]
    texts = [each.text for each in given if each]
    return texts[0] if texts else message.suggestion or ""


def _place(places: tuple[Place, ...]) -> str:
    labels = [f"{each.row}/{each.cell}" if each.cell else f"row {each.row}" for each in places[:3]]
    more = " …" if len(places) > 3 else ""
    return f": {', '.join(labels)}{more}" if labels else ""


def shown(answer: Any) -> str:
    """Return an answer as short text."""
    match answer:
        case {"rows": [*rows], **rest}:
            head = "".join(f"{name}: {value}; " for name, value in rest.items())
            return head + "; ".join(map(shown, rows))
        case {"a": a, "alpha": alpha, "d": d, "theta": theta, **rest}:
            row = ", ".join(map(shown, (a, alpha, d, theta)))
            return f"{row}, {shown(rest)}" if rest else row
        case dict():
            return ", ".join(f"{name}: {shown(value)}" for name, value in answer.items())
        case list() if any(isinstance(each, list | dict) for each in answer):
            return "; ".join(map(shown, answer))
        case list():
            return ", ".join(map(shown, answer))
        case bool():
            return str(answer).lower()
    return str(answer)


# --- the choice of messages for the page

# A template, and the codes of its section; none if the section only has words for others.
Known = tuple[Template, frozenset[str]]


def known_templates() -> list[Known]:
    codes: dict[str, set[str]] = {}
    for section, code in _codes():
        codes.setdefault(section, set()).add(code)
    files = sources(ROOT / "service" / "dh_grader")
    telling = {
        f"{file}#{number}": section
        for file, text in files.items()
        if file.startswith(_READING)
        for number, section in enumerate(_SECTION.split(text))
    }
    return [
        (template, frozenset(codes.get(template.file, ())))
        for template in templates_in(telling)
        if template.text not in _NO_SENTENCES
    ]


@cache
def _codes() -> Sequence[tuple[str, str]]:
    # Each use of a code, with the section of the file: a file has several, with a heading each.
    files = sources(ROOT / "service" / "dh_grader")
    found = []
    for use in messages_page.program():
        before = "".join(files[use.file].splitlines(keepends=True)[: use.line])
        found.append((f"{use.file}#{len(_SECTION.findall(before))}", use.code))
    return found


def all_said() -> Iterator[Said]:
    """Yield all messages that the examples cause."""
    catalogue = exercises()
    yield from said_of_formulas(formulas())
    # A preview without an exercise uses the names of textbooks.
    yield from said_of_formulas(["g0", "h", "beta"], GENERIC)
    yield from said_of_pasted(pasted_texts(), catalogue["planar-rr"])
    yield from said_of_answers(answers(catalogue), catalogue)


@dataclass(frozen=True)
class Row:
    """A line of docs/sentences.md."""

    section: str
    said: Said


def chosen(said: Iterable[Said], known: Iterable[Known]) -> tuple[list[Row], list[Template]]:
    # Return the first message with each template, and the templates without a message.
    #
    # Many sentences may contain a short template. So a short template counts only at the beginning
    # of a sentence, or in a message whose code is in the file of the template.
    unmet = list(known)
    rows: list[Row] = []
    for each in dict.fromkeys(said):
        text = f"{each.sentence}\n{each.correction}"
        met = [
            (template, codes)
            for template, codes in unmet
            if template.is_met_by(text)
            and (
                template.is_telling
                or not codes
                or each.code in codes
                or template.begins(each.sentence)
            )
        ]
        if met:
            rows.append(Row(_section([template for template, _ in met], each.code), each))
            unmet = [one for one in unmet if one not in met]
    return rows, [template for template, _ in unmet]


def _section(met: Iterable[Template], code: str) -> str:
    told = [told for section, told in _codes() for each in met if section == each.file]
    listed: dict[str, set[str]] = {}
    for line in messages_page.LINES:
        listed.setdefault(line.section, set()).add(line.code)
    found = [section for section, codes in listed.items() if code in codes]
    return max(found, key=lambda section: len(listed[section].intersection(told)), default=_SHARED)


# --- the page

_SHARED: Final = "Words of several messages"
_HEAD: Final = """\
# Sentences

This page lists every sentence of a report once, with an answer that causes it.
[Messages](messages.md) says what each code means. After the arrow is the repaired text of an
unreadable entry, or else the correction, which students see at the level `full` only. ↵ means the
end of a line. Formulas without an exercise use the robot of [What you may type](expressions.md).

This page is generated: `python -m tests.docs.sentences > docs/sentences.md`."""
_UNMET: Final = """\
## Without an example

These sentences have no example yet; … means a value that the program inserts."""


def page() -> str:
    """Return the whole page, in Markdown."""
    rows, unmet = chosen(all_said(), known_templates())
    sections = dict.fromkeys(line.section for line in messages_page.LINES)
    blocks = [_HEAD]
    for section in [*sections, _SHARED]:
        lines = [row.said for row in rows if row.section == section]
        if lines:
            order = list(dict.fromkeys(each.code for each in lines))
            lines.sort(key=lambda each: order.index(each.code))
            table = "\n".join(["| Code | Answer | Sentence |", "|---|---|---|", *map(_line, lines)])
            blocks.append(f"## {section}\n\n{table}")
    if unmet:
        blocks.append(_UNMET)
        blocks.append(
            "\n".join(f"- {_cell(each.text)} ({each.file.partition('#')[0]})" for each in unmet)
        )
    return "\n\n".join(blocks) + "\n"


def _line(said: Said) -> str:
    correction = f" → {code_span(said.correction)}" if said.correction else ""
    where = f"{said.where}: " if said.where else ""
    return (
        f"| `{said.code}` | {where}{code_span(said.answer)} | {_cell(said.sentence)}{correction} |"
    )


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", "↵").replace("<", "&lt;")


def code_span(text: str) -> str:
    """Return a text as code in Markdown, shortened if it is long."""
    text = text.replace("\n", END)
    if len(text) > _LONGEST:
        text = f"{text[: _LONGEST // 2]} … {text[-_LONGEST // 4 :]}"
    text = "".join(each if each.isprintable() else f"U+{ord(each):04X}" for each in text)
    fence = "``" if "`" in text else "`"
    blank = " " if "`" in text or not text.strip() else ""
    text = text.replace("|", "\\|")
    return f"{fence}{blank}{text}{blank}{fence}"


if __name__ == "__main__":
    sys.stdout.write(page())
