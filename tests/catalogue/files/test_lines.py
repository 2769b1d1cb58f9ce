"""Find the line number of each value in an exercise file."""

import re
import tomllib
from pathlib import Path

import pytest
from dh_grader.catalogue import shipped_folder
from dh_grader.catalogue.files import line_of, value_lines

TEXT = '''\
title = "A # no comment" # a comment

[robot]  # the robot
table = [
    # a comment with ] and "
    ["a", "b"], ["c", 'd]'],
    ["""e
"f\\" """, "g"],
]
joints = ["q1",
          "q2"]
[symbols]
"a b" = { kind = "length", range = [0.1,
  2] }
c.kind = "angle"
[[parts]]
id = 1
points = 1979-05-27T07:32:00
[[parts.steps]]
axis = "x"
[[parts.steps]]
axis = "y"
[parts.more]
x = \'\'\'
'quoted' [[parts]]
\'\'\'
y = 5
[[parts]]
id = 2
'''

LINES = {
    "title": 1,
    "robot": 3,
    "robot.table": 4,
    "robot.table[0]": 6,
    "robot.table[1][1]": 6,
    "robot.table[2]": 7,
    "robot.table[2][1]": 8,
    "robot.joints[1]": 11,
    "symbols.a b": 13,
    "symbols.a b.range[1]": 14,
    "symbols.c.kind": 15,
    "parts[0]": 16,
    "parts[0].points": 18,
    "parts[0].steps[1]": 21,
    "parts[0].steps[1].axis": 22,
    "parts[0].more.x": 24,
    "parts[0].more.y": 27,
    "parts[1].id": 29,
}


def test_the_text_is_toml() -> None:
    assert tomllib.loads(TEXT)["parts"][0]["more"]["y"] == 5


@pytest.mark.parametrize("field", LINES)
def test_the_line_of_each_value_is_found(field: str) -> None:
    assert value_lines(TEXT)[field] == LINES[field]


@pytest.mark.parametrize(
    ("field", "line"),
    [
        ("robot.table[1].alpha", 6),
        ("parts[1].points", 28),
        ("symbols.nothing.kind", 12),
        ("parts[0].from.literal['base','tool']", 16),
        ("nothing", None),
        ("", None),
    ],
)
def test_a_missing_field_has_the_line_of_the_field_around_it(field: str, line: int | None) -> None:
    assert line_of(field, value_lines(TEXT)) == line


@pytest.mark.parametrize("file", sorted(shipped_folder().glob("*.toml")), ids=lambda f: f.stem)
def test_each_value_of_a_shipped_file_is_on_its_line(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    lines = text.splitlines()
    found = value_lines(text)
    for path, value in leaves(tomllib.loads(text), ""):
        if isinstance(value, str) and "\n" not in value and "\\" not in value:
            assert value in lines[found[path] - 1], path
            key = re.split(r"[.\[]", path)[-1]
            assert key[0].isdigit() or key in lines[found[path] - 1]


def leaves(value: object, path: str) -> list[tuple[str, object]]:
    if isinstance(value, dict):
        pairs = [(f"{path}.{key}".lstrip("."), child) for key, child in value.items()]
    elif isinstance(value, list):
        pairs = [(f"{path}[{i}]", child) for i, child in enumerate(value)]
    else:
        return [(path, value)]
    return [leaf for name, child in pairs for leaf in leaves(child, name)]
