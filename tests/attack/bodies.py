"""Generate requests: model answers of all exercises, with random changes."""

import json
from collections.abc import Callable, Mapping
from copy import deepcopy
from functools import cache
from random import Random
from typing import Any, Final, NamedTuple

from dh_grader.catalogue import Exercise

from tests.attack.in_process import Post, grade_path
from tests.expressions.fuzzing import PIECES, hostile, mutated, seeds
from tests.pasting.test_hostile import FRAGMENTS
from tests.pasting.writers import FORMATS
from tests.shipped import shipped_exercises
from tests.solutions.solved import solved

PREVIEW: Final = "/v1/preview"
COLUMNS: Final = ("a", "alpha", "d", "theta")
HEADERS: Final = ("a", "alpha", "d", "theta", "a [mm]", "alpha (deg)", "θ", "twist", "joint", "")
# Values that replace an entry.
VALUES: Final[tuple[Any, ...]] = (
    0,
    1,
    -1,
    0.5,
    1e308,
    1e-320,
    10**400,
    True,
    None,
    [],
    {},
    "",
    " ",
    "-",
    [[]],
)
SPOILERS: Final = (
    "-({})", "({})", "2*{}", "{} + 0*1.5", "{}/2", "{} ", " {}", "{}*", "{}'", "{};", "x = {}",
    "sin({})", "{} + 1/0", "{} deg", r"\frac{{{}}}{{1}}", "${}$", "{}½", "{}²", "{}\u200b",
)  # fmt: skip


class Model(NamedTuple):
    """An exercise, and an answer with full marks to each of its parts."""

    exercise: Exercise
    answers: Mapping[str, Any]


@cache
def exercises() -> tuple[Exercise, ...]:
    """Return the shipped exercises."""
    return tuple(shipped_exercises().values())


def drawn_model(random: Random) -> Model:
    """Return a random exercise with its model answers."""
    return model_of(random.choice(exercises()))


def model_of(exercise: Exercise) -> Model:
    return Model(exercise, {part.part: part.answer for part in solved(exercise).parts})


@cache
def _texts() -> list[str]:
    return [*seeds(), *hostile()]


def rows_of(answer: Any) -> list[list[str]] | None:
    if isinstance(answer, dict) and isinstance(answer.get("rows"), list):
        rows = answer["rows"]
        if all(isinstance(row, dict) for row in rows):
            return [[_typed(row.get(column, "")) for column in COLUMNS] for row in rows]
    if not isinstance(answer, list) or not answer or not all(isinstance(r, list) for r in answer):
        return None
    if any(isinstance(cell, list | dict) for row in answer for cell in row):
        return None
    return [[_typed(cell) for cell in row] for row in answer]


def _typed(value: Any) -> str:
    return value if isinstance(value, str) else str(value)


def pasted(rows: list[list[str]], random: Random) -> str:
    width = max(map(len, rows), default=0) or 1
    rows = [[*row, *["0"] * (width - len(row))] for row in rows] or [["0"]]
    if random.random() < 0.4:
        rows = [[random.choice(HEADERS) for _ in rows[0]], *rows]
    text = random.choice(list(FORMATS.values()))(rows)
    for _ in range(random.choice((0, 0, 0, 1, 3))):
        at = random.randint(0, len(text))
        text = text[:at] + random.choice(FRAGMENTS) + text[at + random.randint(0, 6) :]
    return text


def _entry(value: Any, random: Random) -> Any:
    kind = random.random()
    if kind < 0.1:
        return random.choice(VALUES)
    if kind < 0.2:
        return random.choice(_texts())
    if kind < 0.3:
        return "".join(random.choices(PIECES, k=random.randint(1, 12)))
    if kind < 0.65:
        return random.choice(SPOILERS).format(_typed(value))
    return mutated(_typed(value), random, _texts())


def spoiled(value: Any, random: Random, share: float) -> Any:
    if isinstance(value, dict):
        return {key: spoiled(each, random, share) for key, each in value.items()}
    if not isinstance(value, list):
        return _entry(value, random) if random.random() < share else value
    listed = [spoiled(each, random, share) for each in value]
    if listed and random.random() < share / 4:
        at = random.randrange(len(listed))
        change: Callable[[], object] = random.choice(
            (
                lambda: listed.pop(at),
                lambda: listed.insert(at, deepcopy(listed[-1])),
                lambda: listed.reverse(),
                lambda: random.shuffle(listed),
            )
        )
        change()
    return listed


def answers_of(model: Model, random: Random) -> dict[str, Any]:
    answers: dict[str, Any] = {}
    share = random.choice((0.0, 0.02, 0.1, 0.1, 0.5, 1.0))
    for part, answer in model.answers.items():
        if random.random() < 0.2:
            continue
        answers[part] = spoiled(answer, random, share)
        rows = rows_of(answers[part])
        if rows and random.random() < 0.4:
            answers[part] = pasted(rows, random)
        elif random.random() < 0.03:
            answers[part] = random.choice((*VALUES, random.choice(_texts())))
    return answers


def submission(random: Random, number: int | None = None) -> Post:
    """Return a request with random answers."""
    # A new `number` gives texts that no cache contains.
    model = drawn_model(random)
    body: dict[str, Any] = {"answers": answers_of(model, random)}
    if random.random() < 0.3:
        body["angle_unit"] = random.choice(("radians", "degrees", "degrees", "grad"))
    if random.random() < 0.1:
        body["feedback"] = random.choice(("full", "hints", "verdicts", "score"))
    if random.random() < 0.3:
        body["echo"] = True
    if number is not None:
        _make_unique(body["answers"], number)
    if random.random() < 0.05:
        body = {"submissions": [{"exercise": model.exercise.id} | body]}
        return Post("/v1/grade", _encoded(body, random))
    return Post(grade_path(model.exercise), _encoded(body, random))


def _make_unique(answers: dict[str, Any], number: int) -> None:
    for part, answer in answers.items():
        if isinstance(answer, str):
            continue
        answers[part] = _with_zero(answer, number)[0]


def _with_zero(value: Any, number: int) -> tuple[Any, bool]:
    if isinstance(value, str) and value.strip():
        return f"{value} + 0*{number}", True
    if isinstance(value, dict | list):
        places: Any = list(value) if isinstance(value, dict) else range(len(value))
        for place in places:
            changed, done = _with_zero(value[place], number)
            if done:
                value = dict(value) if isinstance(value, dict) else list(value)
                value[place] = changed
                return value, True
    return value, False


def preview(random: Random, number: int | None = None) -> Post:
    model = drawn_model(random)
    part = random.choice(list(model.answers))
    rows = rows_of(spoiled(model.answers[part], random, 0.2))
    if rows and random.random() < 0.7:
        text = pasted(rows, random)
    else:
        text = str(_entry(random.choice(random.choice(rows)) if rows and rows[0] else "q1", random))
    if number is not None:
        text = f"{text} + 0*{number}"
    body: dict[str, Any] = {"text": text}
    if random.random() < 0.9:
        body["exercise"] = model.exercise.id
        if random.random() < 0.9:
            body["part"] = part
    if random.random() < 0.3:
        body["angle_unit"] = "degrees"
        body["quantity"] = random.choice(("angle", "length", "number"))
    return Post(PREVIEW, _encoded(body, random))


def _encoded(body: Any, random: Random) -> bytes:
    data = bytearray(
        json.dumps(body, ensure_ascii=random.random() < 0.5).encode("utf-8", "replace")
    )
    if random.random() < 0.03:
        at = random.randrange(len(data) + 1)
        data[at : at + random.randint(0, 3)] = random.randbytes(random.randint(0, 3))
    return bytes(data)
