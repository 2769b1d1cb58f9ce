"""The first request bodies in the search for costly requests."""

import random
from collections.abc import Iterator, Mapping
from typing import Any

from dh_grader.catalogue import Exercise

from tests.expressions.fuzzing import hostile, seeds
from tests.worst.entry_points import FILE, FRAMES, GRADE, PREVIEW, PREVIEWS, SUBMITTED, Attack

KEYS = ("a", "alpha", "d", "theta")
HALVES = "½" * 78
LONG_TABLE = ["=", "=", "=", {}, "=", ["0^-1", "sqrt(q1)", "theta1", "atan2(0,0)"]]


def halves(i: int, runs: int = 6) -> str:
    return "//".join([HALVES] * runs) + str(i)


def grid(rows: int, columns: int, runs: int = 6) -> list[list[str]]:
    return [[halves(columns * i + j, runs) for j in range(columns)] for i in range(rows)]


def padded(rows: int, size: int = 16_000, pad: str = "$") -> str:
    lines = [", ".join(f"c{(i + j) % 3 + 1}" for j in range(4)) for i in range(rows)]
    return "\n".join(lines) + "\n" + pad * (size - sum(map(len, lines)) - rows)


LONGEST_PASTED = 26 * 1024
# Signs that a reader of pasted texts may search again and again, in runs and nested.
RUNS = (
    "(", ")", "()", "[]", "{}", "[[", "'", '"', "''", '"" ', "$", "$$", " ", "\t", "\n", ",", ", ",
    ";", "\\", "\\\\", "\\, ", "|", "&", "1", "12 ", "x", "a1 ", "matrix", "a = ", "a: ", "a.", "%",
    "# ", "//", "/*", "(*", "...", "`", "**", "<", "<td>", "_", "^", "-", ">>> ", "(a, ", "'a', ",
    "½", "θ₁", "\x85", "\r", "，", "；", "｜", "（", "（）", "【",
)  # fmt: skip
AROUND = (
    ("", ""), ("[", "]"), ("A1 = [1, 2; 3, 4]\nA2 = ", ""), ("DH = [1 2 3 4];\nT = ", ""),
    ("[1, 2; 3, ", "]"), ("a = [1]; alpha = [2]; d = [3]; theta=[", ""), ("{'a': 1, ", "}"),
    ("Link('d', 1); SerialLink(", ")"), ("\\begin{bmatrix} 1 & 2 \\\\ ", "\\end{bmatrix}"),
    ("'", "'"), ("f(", "[1, 2])"), ("| a | b |\n|---|---|\n| ", "|"), ("1, 2, 3, 4\n", ""),
    ("Link 1: a = ", ", alpha = 0, d = 1, theta = q1"), ("T = [■(1&2@", "@3&4)]"),
)  # fmt: skip
NESTING = (("(", ")"), ("[", "]"), ("{", "}"), ("\\left(", "\\right)"), ("f(", ")"), ("$", "$"))


def run(before: str, unit: str, after: str = "", size: int = LONGEST_PASTED) -> str:
    """Return a text of ``size`` characters that is mostly ``unit``, again and again."""
    left = size - len(before) - len(after)
    return before + (unit * (left // len(unit) + 1))[:left] + after


def runs(choose: random.Random, number: int) -> Iterator[str]:
    """Yield long texts of few signs: in runs, in nested pairs, and mixed."""
    for _ in range(number):
        before, after = choose.choice(AROUND)
        size = choose.choice((3_000, 8_000, 12_000, LONGEST_PASTED))
        unit = "".join(choose.choices(RUNS, k=choose.choice((1, 1, 1, 2, 3))))
        if choose.random() < 0.3:
            opener, closer = choose.choice(NESTING)
            depth = choose.choice((50, 500, 3_900, 12_900))
            before, after = before + opener * depth, closer * depth + after
        yield run(before, unit, after, max(size, len(before) + len(after)))


def links_of(text: str, number: int = 0, links: int = 6) -> list[list[list[str]]]:
    return [
        [[f"{text}+{1000 * number + 16 * k + 4 * i + j}" for j in range(4)] for i in range(4)]
        for k in range(links)
    ]


def previews_of(exercise: str, part: str, text: str) -> Attack:
    entries = [{"text": f"{text}+{i}", "quantity": "length"} for i in range(192)]
    return Attack(PREVIEWS, exercise, {"exercise": exercise, "part": part, "entries": entries})


def frames_of(exercise: str, joints: int, text: str) -> Attack:
    rows = [dict.fromkeys(KEYS[:3], f"{text}+{i}") | {"theta": f"q{i + 1}"} for i in range(joints)]
    values = [[0.1 * k + 0.01 * i for i in range(joints)] for k in range(30)]
    body = {"exercise": exercise, "table": {"rows": rows}, "joints": values, "figure": "auto"}
    return Attack(FRAMES, exercise, body)


def free_frames_of(exercise: str, text: str, **other: object) -> Attack:
    rows = [
        {key: f"{text}+{3 * i + j}" for j, key in enumerate(KEYS[:3])} | {"theta": f"q{i + 1}"}
        for i in range(12)
    ]
    table = {"structure": "RPRPRPRPRP", "formulas": True, "rows": rows} | other
    values = [[0.1 * k] * 10 for k in range(30)]
    return Attack(FRAMES, exercise, {"table": table, "joints": values, "figure": "auto"})


def garbage_table(rows: int, choose: random.Random) -> list[list[str]]:
    return [[f"{choose.uniform(-3, 3):.3g}" for _ in KEYS] for _ in range(rows)]


def cells() -> list[str]:
    return [
        *seeds(), *hostile(), HALVES, halves(0), "//" * 200, "=", "sqrt(q1)", "0^-1", "atan2(0,0)",
        "½" * 240, "(" * 120, "x" * 240, "q9 " * 80, "sin" * 80, "1,5 " * 60, "θ₁" * 100, "$" * 240,
        r"\frac{" * 40, "a1 + " * 48, "c123 " * 50, "-" * 200 + "1", "sinq1 cosq2 " * 20,
        "qq1*" * 60, "1.23", "-0.456", "0.785", "1/0", "theta1 + 0.001", "l1 mm", "90deg deg",
    ]  # fmt: skip


def answers_of(exercise: Exercise) -> Iterator[dict[str, Any]]:
    """Yield the sample answers in the exercise file."""
    for check in exercise.checks:
        yield dict(check.answers)


def _spread(exercise: Exercise, choose: random.Random) -> Iterator[dict[str, Any]]:
    tables, matrices, links = {}, {}, {}
    joints = max(len(exercise.joints), 3)
    for part in exercise.parts:
        if part.kind == "dh_table":
            tables[part.id] = garbage_table(joints, choose)
        elif part.kind == "link_transforms":
            links[part.id] = joints
        else:
            matrices[part.id] = 4 if part.kind == "transform" else 3
    if tables:
        yield dict(tables)
        for rows in (joints + 1, joints + 3, 12):
            yield {name: garbage_table(rows, choose) for name in tables}
        yield {name: {"rows": LONG_TABLE} for name in tables}
        yield {name: {"rows": [*LONG_TABLE[:4]] + [{}] * joints} for name in tables}
    for pad in "$ &|,":
        pasted = {name: padded(4 * count, pad=pad) for name, count in links.items()}
        yield tables | pasted | {name: padded(size) for name, size in matrices.items()}
    yield {name: grid(size, size) for name, size in matrices.items()} | {
        name: [grid(4, 4)] * count for name, count in links.items()
    }


def _free_frames(name: str) -> Iterator[Attack]:
    for text in ("sin(30)" * 60, "a1 " * 60, "c12 " * 30, "√2 " * 30, "a1", halves(0)):
        for convention in ("standard", "modified"):
            yield free_frames_of(name, text, convention=convention)
    # The longest poses that are still printed.
    for cell in ("alpha1", "cos(theta1)", "sin(30)" * 20):
        for count in range(2, 6):
            rows = [["a1", cell, "d1", f"q{i + 1}"] for i in range(count)]
            yield free_frames_of(name, "", rows=rows)


def _runs(name: str, exercise: Exercise, choose: random.Random) -> Iterator[Attack]:
    for text in runs(choose, 3):
        for entry in SUBMITTED:
            yield Attack(entry, name, {"answers": {part.id: text for part in exercise.parts}})
        for part in exercise.parts:
            yield Attack(PREVIEW, name, {"text": text, "exercise": name, "part": part.id})


def _previews(name: str, exercise: Exercise) -> Iterator[Attack]:
    for part in exercise.parts:
        for text in ("c12 " * 16, "sind(30)" * 8, HALVES):
            yield previews_of(name, part.id, text)
        for runs in (1, 6):
            text = "\n".join(map(", ".join, grid(8, 4, runs)))
            body = {"text": text, "exercise": name, "part": part.id}
            yield Attack(PREVIEW, name, body)


def attacks(exercises: Mapping[str, Exercise], seed: int) -> Iterator[Attack]:
    """Yield the first request bodies of the search."""
    choose = random.Random(seed)
    for name, exercise in exercises.items():
        bodies = [*answers_of(exercise), *(each for each in _spread(exercise, choose) if each)]
        for answers in bodies:
            for entry in SUBMITTED:
                yield Attack(entry, name, {"answers": answers})
            for answered, answer in answers.items():
                if isinstance(answer, str):
                    body = {"text": answer, "exercise": name, "part": answered}
                    yield Attack(PREVIEW, name, body)
        yield from _runs(name, exercise, choose)
        if exercise.reference is not None:
            yield frames_of(name, len(exercise.joints), "sin(30)" * 60)
            yield frames_of(name, len(exercise.joints), halves(0))
        yield from _previews(name, exercise)
    name = next(iter(exercises))
    yield from _free_frames(name)
    for text in cells():
        yield Attack(PREVIEW, name, {"text": text})
    yield Attack(GRADE, name, {"answers": {f"part{i}": 0 for i in range(15_500)}})
    yield Attack(FILE, name, {"answers": {f"part{i}": 0 for i in range(15_500)}})
