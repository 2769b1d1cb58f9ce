"""Annotations, read as the runner does: src/Runner.Common/ActionCommand.cs of actions/runner."""

from dataclasses import dataclass

import pytest

from tests.formats.submissions import HOSTILE, cases, document


@dataclass(frozen=True)
class Command:
    name: str
    properties: dict[str, str]
    data: str


def unescaped(text: str, *, is_property: bool) -> str:
    pairs = [("%0D", "\r"), ("%0A", "\n")]
    pairs += [("%3A", ":"), ("%2C", ",")] if is_property else []
    for replacement, sign in [*pairs, ("%25", "%")]:
        text = text.replace(replacement, sign)
    return text


def parsed(line: str) -> Command:
    """What the runner makes of a line: up to the next `::` stand name and properties."""
    assert line.lstrip().startswith("::")
    head, _, data = line.lstrip()[2:].partition("::")
    name, _, properties = head.partition(" ")
    pairs = [each.split("=", 1) for each in properties.strip().split(",")]
    found = {key: unescaped(value, is_property=True) for key, value in pairs}
    return Command(name, found, unescaped(data, is_property=False))


def read(case: str) -> list[Command]:
    return [parsed(line) for line in document("github", cases()[case]).split("\n")[:-1]]


@pytest.mark.parametrize("case", cases())
def test_every_line_is_one_annotation(case: str) -> None:
    commands = read(case)
    # More than ten of a kind are not shown.
    assert 0 < len(commands) <= 10
    for command in commands:
        assert command.name in ("error", "warning", "notice")
        assert set(command.properties) <= {"file", "title"}
        assert command.properties["title"]
        assert command.data
        # 64 KB are what a message may have.
        assert len(command.data.encode()) < 65_536


def test_a_part_is_told_with_its_messages() -> None:
    table, pose, total = read("wrong")
    assert table.name == "warning"
    assert table.properties == {
        "file": "folder/anna.json", "title": "Denavit-Hartenberg table: 3.79 / 8 points",
    }  # fmt: skip
    assert table.data.startswith("✗ row 2 alpha: ")
    assert len(table.data.split("\n")) == 2
    assert pose.properties["title"] == "Pose of the end effector: 7 / 8 points"
    assert (total.name, total.properties["title"]) == ("error", "Not passed")
    assert total.data == "10.79 / 16 points, 67.4 %. 80 % is needed to pass."


def test_a_right_one_has_a_notice_alone() -> None:
    [total] = read("right")
    assert (total.name, total.properties["title"]) == ("notice", "Passed")
    assert total.data == "16 / 16 points, 100 %. 80 % is needed to pass."


def test_a_file_that_cannot_be_used_is_an_error() -> None:
    *parts, total = read("unusable")
    assert [part.name for part in parts] == ["error", "error"]
    assert (total.name, total.properties["title"]) == ("error", "Not graded")


def test_hostile_text_comes_through_whole_and_as_text() -> None:
    first = read("hostile words")[0]
    # All but the controls and the signs of commands, in the title, the file and the message.
    for word in ("/C calc'!A0", "<script>", "a||b".replace("||", " || "), "100% %0A, $x$"):
        assert word in HOSTILE
        assert word in first.properties["file"]
        assert word in first.properties["title"]
    assert "100% %0A, $x$" in read("unusable")[0].data
