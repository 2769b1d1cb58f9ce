"""Test annotations for GitHub."""

# They are parsed as in the runner of GitHub (src/Runner.Common/ActionCommand.cs).

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
    """Return the GitHub command in a line: its name, properties and message."""
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
    # GitHub shows at most ten of each kind.
    assert 0 < len(commands) <= 10
    for command in commands:
        assert command.name in ("error", "warning", "notice")
        assert set(command.properties) <= {"file", "title"}
        assert command.properties["title"]
        assert command.data
        # A message has at most 64 KB.
        assert len(command.data.encode()) < 65_536


def test_an_annotation_has_the_messages_of_its_part() -> None:
    table, pose, total = read("wrong")
    assert table.name == "warning"
    assert table.properties == {
        "file": "folder/anna.json", "title": "Denavit-Hartenberg table: 4 / 8 points",
    }  # fmt: skip
    assert table.data.startswith("✗ row 2 alpha: ")
    *_, lost, zeros = table.data.split("\n")
    assert lost == "−2: α in row 2; −2: θ in row 3"
    assert zeros.startswith("Row 1 is worth little: ")
    assert pose.properties["title"] == "Pose of the end effector: 7 / 8 points"
    assert (total.name, total.properties["title"]) == ("error", "Not passed")
    assert total.data == "11 / 16 points, 68.7 %. 80 % is needed to pass."


def test_a_right_submission_has_only_a_notice() -> None:
    [total] = read("right")
    assert (total.name, total.properties["title"]) == ("notice", "Passed")
    assert total.data == "16 / 16 points, 100 %. 80 % is needed to pass."


def test_a_file_that_cannot_be_used_is_an_error() -> None:
    *parts, total = read("unusable")
    assert [part.name for part in parts] == ["error", "error"]
    assert (total.name, total.properties["title"]) == ("error", "Not graded")


def test_hostile_text_arrives_complete_and_as_text() -> None:
    first = read("hostile words")[0]
    # In title, file and message, all but control characters and the starts of commands.
    for word in ("/C calc'!A0", "<script>", "a||b".replace("||", " || "), "100% %0A, $x$"):
        assert word in HOSTILE
        assert word in first.properties["file"]
        assert word in first.properties["title"]
    assert "100% %0A, $x$" in read("unusable")[0].data
