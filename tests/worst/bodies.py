"""The costliest request bodies found so far, by name."""

from collections.abc import Mapping
from typing import Final

from tests.worst.entry_points import (
    ATTEMPTS,
    BATCH,
    FILE,
    FRAMES,
    GRADE,
    HINTS,
    PREVIEW,
    SOLUTION,
    Attack,
)
from tests.worst.seeds import (
    HALVES,
    LONG_TABLE,
    frames_of,
    free_frames_of,
    grid,
    halves,
    links_of,
    padded,
    previews_of,
    run,
)

ARM: Final = "stanford-arm"


# Shorthand, which differs from the symbols that it means.
_SUMS = [["c12 " * 33 + f"+{4 * i + j}" for j in range(4)] for i in range(12)]


def _graded(**answers: object) -> Attack:
    return Attack(GRADE, ARM, {"answers": answers})


def _previewed(text: str, part: str) -> Attack:
    return Attack(PREVIEW, ARM, {"text": text, "exercise": ARM, "part": part})


_HALVES: Final = [[halves(4 * i + j) for j in range(4)] for i in range(4)]
_REPAIRS: Final = [[f"(tehta1 + {i}.{j}" for j in range(4)] for i in range(6)]
_DECIMALS: Final = [[f"{0.317 * (i + 2) * (j - 1.7):.3g}" for j in range(4)] for i in range(7)]
_TWELVE_ROWS: Final = [
    [f"{0.271 * (i + 1) * (j - 1.3) + i:.3g}" for j in range(4)] for i in range(12)
]
_UNKNOWN: Final = {"answers": {f"part{i}": 0 for i in range(15_500)}}


def _everywhere(text: str) -> Attack:
    return _graded(links=[text] * 6, pose=text, table=text)


# The pasted texts that cost most, at each entry point that reads pasted texts.
NESTED: Final = "[" + "(" * 12_900 + ")" * 12_900 + "]"
_PASTED: Final[Mapping[str, str]] = {
    "nested brackets": NESTED,
    "nested brackets around a word": run("[" + "(" * 3_900, "x", ")" * 3_900 + "]"),
    "pairs of brackets": run("[" + "()" * 3_900, "x", "]"),
    "a long word after a table": run("A1 = [1, 2; 3, 4]\nA2 = ", "matrix"),
    "slashes in a list": run("a = [1]; alpha = [2]; d = [3]; theta=[", "/"),
    "dollars in quotes": run("'", "$", "'"),
    "short words in brackets": run("[", "a1 ", "]"),
}

# A text that may be several answers, in each part; what stands below its rows is read with them.
_ROWS_AND_DOLLARS: Final = run("c1, c2, c3, c1\nc2, c3, c1, c2\nc3, c1, c2, c3\n", "$")

# A table of an honest client, in which a row is missing and the last one moves nothing.
_FEW_ROWS: Final = [
    {"a": "0*0.649546", "alpha": "0", "d": "-(0)", "theta": "0"},
    {"a": "l1", "alpha": "0", "d": "0", "theta": "q2"},
    {"a": "l2", "alpha": "0", "d": "0", "theta": "q3"},
    {"a": "0", "alpha": "0", "d": "0", "theta": "0"},
]

KNOWN: Final[Mapping[str, Attack]] = {
    "a table with a row too few": Attack(
        GRADE, "planar-rrr", {"answers": {"table": {"rows": _FEW_ROWS}}}
    ),
    "rows and dollars in each part": Attack(
        GRADE,
        "dh-conditions",
        {"answers": dict.fromkeys(("first", "second", "third", "fourth"), _ROWS_AND_DOLLARS)},
    ),
    "cells that nearly repair": _graded(pose=_HALVES),
    "cells that nearly repair, in several parts": _graded(pose=_HALVES, links=[_HALVES] * 6),
    "a grid of cells that nearly repair": _previewed("\n".join(map(", ".join, grid(8, 4))), "pose"),
    "links padded with dollars": _graded(table=[["0"] * 4] * 6, links=padded(24)),
    # Each such comma has three bytes, so one part is all that a body holds.
    "commas of a Chinese keyboard": _graded(table=run("", "1" + "，" * 20 + "\n", size=19_000)),
    "links and a pose of brackets": _graded(links="(" * 2_400, pose="[" * 2_400),
    "many cells that each nearly repair": _graded(table={"rows": _REPAIRS}),
    "constants to be computed": _graded(pose=[["sind(30)" * 100 + f"+{i}"] * 4 for i in range(4)]),
    "links of sines and cosines": _graded(links=links_of("c12 " * 33)),
    "links of sines in degrees": _graded(links=links_of("sind(30)" * 25)),
    "links of fractions": _graded(links=links_of(r"\frac{1}{2}" * 18)),
    "links of constants": _graded(links=links_of("pi " * 90)),
    "links of roots": _graded(links=links_of("√2 " * 65)),
    "runs of letters": _graded(pose=[["sin" * 26 + f" x{i}"] * 4 for i in range(4)]),
    "unread cells": _graded(table={"rows": LONG_TABLE}),
    "unread cells in another unit": Attack(
        GRADE, ARM, {"answers": {"table": {"rows": LONG_TABLE}}, "angle_unit": "degrees"}
    ),
    "unread cells in either convention": Attack(
        GRADE, f"{ARM}-either", {"answers": {"table": {"rows": LONG_TABLE}}}
    ),
    "decimals of three figures": _graded(table=_DECIMALS[:6]),
    "rows too many and one unread, all free": Attack(
        GRADE,
        "robot-6-all-free",
        {"answers": {"table": [*_TWELVE_ROWS[:2], _TWELVE_ROWS[2][:3], *_TWELVE_ROWS[3:]]}},
    ),
    "rows too many, in either convention": Attack(
        FILE, "stanford-arm-drawn-either", {"answers": {"table": _TWELVE_ROWS}}
    ),
    "a row too many, a cell unread, and padded links": _graded(
        table=[*_DECIMALS[:6], ["", *_DECIMALS[6][1:]]], links=padded(24)
    ),
    "decimals and halves, told in a file": Attack(
        FILE,
        f"{ARM}-either",
        {"answers": {"table": _DECIMALS[:6], "links": [_DECIMALS[:4]] * 6, "pose": _HALVES}},
    ),
    "sums by their shorthand, told in a file": Attack(
        FILE, ARM, {"answers": {"table": _SUMS[:12], "links": [_SUMS[i : i + 4] for i in range(6)]}}
    ),
    "long rows of names": Attack(
        GRADE, ARM, {"answers": {"table": [{f"k{i}": 0 for i in range(1500)}] * 12}}
    ),
    "a cell as long as a body may be": _graded(pose=[["1+" * 125_000 + "1"]]),
    "cells of many words": _graded(pose=[[" ".join(f"a{i}" for i in range(5_000))] * 4] * 2),
    "a long formula": _previewed("+".join(["(2q1c12q2)"] * 180), "pose"),
    "a formula of halves": _previewed("½" * 8_000, "pose"),
    "many previews": previews_of(ARM, "links", "c12 " * 16),
    "many previews of halves": previews_of(ARM, "links", HALVES),
    "frames of long cells": frames_of(ARM, 6, "sin(30)" * 60),
    "frames of halves": frames_of(ARM, 6, halves(0)),
    "a free table of long cells": free_frames_of(ARM, "sin(30)" * 60),
    "a free table of long cells without a figure": Attack(
        FRAMES, ARM, {**free_frames_of(ARM, "sin(30)" * 60).body, "figure": None}
    ),
    "decimals and halves, recorded": Attack(
        ATTEMPTS,
        f"{ARM}-either",
        {"answers": {"table": _DECIMALS[:6], "links": [_DECIMALS[:4]] * 6, "pose": _HALVES}},
    ),
    "unknown parts": Attack(GRADE, ARM, _UNKNOWN),
    "unknown fields": Attack(GRADE, ARM, {**_UNKNOWN["answers"], "answers": {}}),
    "unknown parts in a file": Attack(FILE, ARM, _UNKNOWN),
    **{name: _everywhere(text) for name, text in _PASTED.items()},
    **{f"{name}, previewed": _previewed(text, "links") for name, text in _PASTED.items()},
    "thin spaces, previewed": _previewed(run("{'a': 1, ", "\\, ", "}"), "links"),
    **{
        f"nested brackets at {entry}": Attack(entry, ARM, _everywhere(NESTED).body)
        for entry in (ATTEMPTS, FILE, BATCH, HINTS, SOLUTION)
    },
    **{
        f"{text} at {entry}": Attack(entry, ARM, {"answers": {"links": links_of(cell)}})
        for entry in (BATCH, HINTS, SOLUTION)
        for text, cell in {"sines in degrees": "sind(30)" * 25, "roots": "√2 " * 65}.items()
    },
}

# A table of random decimals may cost more than other answers, until it is judged with less work.
OF_DECIMALS: Final = frozenset({name for name in KNOWN if "decimals" in name or "rows too" in name})
