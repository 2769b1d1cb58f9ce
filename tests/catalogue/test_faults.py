"""Every fault of an exercise file is reported with file, field and reason."""

import os
import re
from pathlib import Path
from typing import Any

import pytest
from dh_grader.catalogue import CatalogueError, load_catalogue, load_exercise
from dh_grader.catalogue.kinds import SPECS
from dh_grader.catalogue.schema import (
    CheckSpec,
    ExerciseSpec,
    ExpectSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
)
from dh_grader.translations import LANGUAGES, told
from pydantic import BaseModel, TypeAdapter, ValidationError

from tests.guards import ANSWER
from tests.together import together

VALID = """\
title = "An arm"
source = "made for this test"
statement = "Two joints."

[robot]
structure = "RP"
convention = "standard"
joints = ["theta1", "d2"]
table = [
    ["a1", "90deg", "0", "theta1 + pi/2"],
    ["0", "0", "d2 + a1", "0"],
]

[symbols]
a1 = { kind = "length", range = [0.3, 0.9], description = "a length" }
k = { kind = "number", description = "a number" }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
convention = "standard"

[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
points = 4
"""


def write(folder: Path, text: str, name: str = "arm.toml") -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def changed(*changes: tuple[str, str]) -> str:
    text = VALID
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


# A replacement, the expected field, and a pattern of the expected reason.
FAULTS: dict[str, tuple[tuple[str, str], str, str]] = {
    "not TOML": (('structure = "RP"', 'structure = "RP'), "", r"TOML.*line 6"),
    "a key twice": (('title = "An arm"', 'title = "An arm"\ntitle = "B"'), "", r"TOML.*line 2"),
    "unknown key": (("source =", 'sauce = "x"\nsource ='), "sauce", "there is no key"),
    "unknown key of the robot": (
        ("joints =", "links = 3\njoints ="),
        "robot.links",
        "there is no key",
    ),
    "unknown key of a part": (("points = 4", "marks = 4"), "parts[1].marks", "there is no key"),
    "unknown key of a symbol": (("range =", "limits ="), "symbols.a1.limits", "there is no key"),
    "title missing": (('title = "An arm"\n', ""), "title", "required"),
    "title blank": (('"An arm"', '"  "'), "title", "at least 1"),
    "a title that turns around": (('"An arm"', r'"An \u202earm"'), "title", r"U\+202E"),
    "a prompt that no page can hold": (
        ("points = 4", r'prompt = "a\u0001"' + "\npoints = 4"),
        "parts[1].prompt",
        r"U\+0001",
    ),
    "a statement without end": (
        ("Two joints.", "x" * 20_001),
        "statement",
        "20,001 characters; write at most 20,000",
    ),
    "title of another type": (('"An arm"', "5"), "title", "write it in quotation marks"),
    "no parts": ((VALID[VALID.index("[[parts]]") :], ""), "parts", "required"),
    "points of another type": (("points = 4", 'points = "many"'), "parts[1].points", "number"),
    "points as text": (
        ("points = 4", 'points = "4"'),
        "parts[1].points",
        "without quotation marks",
    ),
    "a share as text": (
        ("points = 4", 'follows = "table"\nfollows_from = "0.5"'),
        "parts[1].follows_from",
        "without quotation marks",
    ),
    "a boolean as text": (
        ("points = 4", 'home = "true"'),
        "parts[1].home",
        "without quotation marks",
    ),
    "a boolean as a number": (("points = 4", "home = 1"), "parts[1].home", "write true or false"),
    "points of nothing": (("points = 4", "points = 0"), "parts[1].points", "greater than 0"),
    "points below nothing": (("points = 4", "points = -1"), "parts[1].points", "greater than 0"),
    "points beyond bounds": (("points = 4", "points = 1e9"), "parts[1].points", "1000"),
    "points that are no number": (("points = 4", "points = nan"), "parts[1].points", "."),
    "points as a boolean": (("points = 4", "points = true"), "parts[1].points", "number"),
    "part id twice": (('id = "pose"', 'id = "table"'), "", "'table'"),
    "part id that is no name": (('id = "pose"', 'id = "The Pose"'), "parts[1].id", "pattern"),
    "unknown kind": (('kind = "transform"', 'kind = "quaternion"'), "parts[1]", "transform"),
    "kind missing": (('kind = "transform"\n', ""), "parts[1]", "kind"),
    "unknown convention": (
        ('convention = "standard"\njoints', 'convention = "craig"\njoints'),
        "robot.convention",
        "'standard' or 'modified'",
    ),
    "unknown freedom": (
        ('kind = "dh_table"', 'kind = "dh_table"\nframes = "any"'),
        "parts[0].frames",
        "'given'",
    ),
    "structure letters": (('structure = "RP"', 'structure = "RX"'), "robot.structure", "RP"),
    "structure empty": (('structure = "RP"', 'structure = ""'), "robot.structure", "RP"),
    "structure longer than the joints": (('"RP"', '"RPR"'), "robot", "3 joints"),
    "too few rows": (('    ["0", "0", "d2 + a1", "0"],\n', ""), "robot", r"1 rows.*write 2"),
    "a row of three": (('["0", "0", "d2 + a1", "0"]', '["0", "0", "d2"]'), "robot.table[1]", "."),
    "a cell of another type": (('["0", "0"', '["0", ["0"]'), "robot.table[1][1]", "."),
    "a cell as a boolean": (('["0", "0"', '["0", true'), "robot.table[1][1]", "."),
    "a cell as a date": (('["0", "0"', '["0", 2024-01-01'), "robot.table[1][1]", "."),
    "unreadable formula": (('["a1"', '["a1 +"'), "robot.table[0].a", "did you mean 'a1'"),
    "unknown symbol": (('["a1"', '["a7"'), "robot.table[0].a", "a7"),
    "infinite cell": (('["a1"', "[inf"), "robot.table[0].a", "finite"),
    "undefined cell": (('["a1"', '["1/0"'), "robot.table[0].a", "."),
    "sometimes undefined cell": (('["a1"', '["sqrt(a1 - 10)"'), "robot.table[0].a", "."),
    "joint variable in the wrong column": (
        ('["0", "0", "d2 + a1", "0"]', '["d2", "0", "0", "0"]'),
        "robot.table[1].a",
        "constant",
    ),
    "joint variable missing": (('"theta1 + pi/2"', '"pi/2"'), "robot.table[0].theta", "theta1"),
    "joint variable of another joint": (
        ('"theta1 + pi/2"', '"theta1 + d2"'),
        "robot.table[0].theta",
        "theta1",
    ),
    "joint variable with a minus": (
        ('"theta1 + pi/2"', '"pi/2 - theta1"'),
        "robot.table[0].theta",
        "theta1 plus a constant",
    ),
    "joint variable doubled": (
        ('"theta1 + pi/2"', '"2*theta1"'),
        "robot.table[0].theta",
        "theta1 plus a constant",
    ),
    "joint variable in a function": (
        ('"theta1 + pi/2"', '"sin(theta1)"'),
        "robot.table[0].theta",
        "theta1 plus a constant",
    ),
    "range reversed": (("[0.3, 0.9]", "[0.9, 0.3]"), "symbols.a1.range", "0.9 to 0.3"),
    "range of nothing": (("[0.3, 0.9]", "[0.3, 0.3]"), "symbols.a1.range", "low to high"),
    "range of one": (("[0.3, 0.9]", "[0.3]"), "symbols.a1.range", "."),
    "range with a symbol": (("[0.3, 0.9]", '[0.3, "k"]'), "symbols.a1.range[1]", "k"),
    "range without end": (("[0.3, 0.9]", '[0.3, "1/0"]'), "symbols.a1.range", "."),
    "range that is no number": (("[0.3, 0.9]", "[0.3, nan]"), "symbols.a1.range", "finite"),
    "unknown kind of symbol": (('kind = "number"', 'kind = "mass"'), "symbols.k.kind", "'angle'"),
    "kind of a joint variable": (
        ("k = {", 'theta1 = { kind = "length", description = "joint" }\nk = {'),
        "symbols.theta1.kind",
        "'angle'",
    ),
    "symbol that is no name": (("k = {", '"k!" = {'), "symbols", "k!"),
    "symbol named like a function": (("k = {", "sin = {"), "symbols", "sin"),
    "symbol named like pi": (("k = {", "pi = {"), "symbols", "pi"),
    "two spellings of one name": (("k = {", "a_1 = {"), "symbols", "a1"),
    "joint variables of one name": (('"theta1", "d2"]', '"d2", "d2"]'), "symbols", "d2"),
    "a constant named like a joint": (("k = {", "theta_1 = {"), "symbols", "theta1"),
    "standard part where the robot has none": (
        ('convention = "standard"\njoints', 'convention = "modified"\njoints'),
        "parts[0].convention",
        "no standard table",
    ),
}


@together("name", FAULTS)
def test_a_fault_is_reported_with_its_field(name: str, tmp_path: Path) -> None:
    change, field, reason = FAULTS[name]
    file = write(tmp_path, changed(change))
    with pytest.raises(CatalogueError) as caught:
        load_exercise(file)
    faults = caught.value.faults
    assert {fault.file for fault in faults} == {file}
    assert [f for f in faults if field in f.field and re.search(reason, f.reason)], faults
    assert str(caught.value).startswith(f"{file}: {faults[0].field}".removesuffix(": "))
    german = LANGUAGES["de"].translation
    assert [fault for fault in faults if told(fault.reason, german) == fault.reason] == []
    assert told(faults[0].reason, german) in told(caught.value.args[0], german)


@pytest.mark.parametrize(
    "name", ["Bad Name", "Arm", "arm-", "-arm", "1arm", "a--b", "a.b", "ärm", "arm\n", "a" * 61]
)
def test_the_name_of_a_file_is_an_id(name: str, tmp_path: Path) -> None:
    write(tmp_path, VALID, f"{name}.toml")
    with pytest.raises(CatalogueError, match=r"write small letters and digits"):
        load_catalogue(tmp_path)


MODELS = [*SPECS.values(), ExerciseSpec, RobotSpec, ScrewRobotSpec, SymbolSpec, CheckSpec]


@pytest.mark.parametrize("model", [*MODELS, ExpectSpec], ids=lambda model: model.__name__)
def test_no_value_is_converted_to_another_type(model: type[BaseModel]) -> None:
    for name, field in model.model_fields.items():
        adapter = TypeAdapter[Any](field.rebuild_annotation())
        for value in ("1", "0.5", "true", "yes", 0, 1, 0.5, True, False):
            try:
                found = adapter.validate_python(value)
            except ValidationError:
                continue
            assert found == value, (name, value)
            assert isinstance(found, bool) is isinstance(value, bool), (name, value)
            assert isinstance(found, str) is isinstance(value, str), (name, value)


def test_the_file_without_faults_loads(tmp_path: Path) -> None:
    exercise = load_exercise(write(tmp_path, VALID))
    assert (exercise.id, exercise.robot.structure) == ("arm", "RP")
    assert [variable.name for variable in exercise.variables] == ["theta1", "d2", "a1", "k"]
    assert [(joint.index, joint.column) for joint in exercise.robot.joints] == [
        (1, "theta"),
        (2, "d"),
    ]


def test_at_least_fifteen_faults_are_tested() -> None:
    assert len(FAULTS) >= 15


def test_an_empty_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CatalogueError, match=r"no exercise file") as caught:
        load_catalogue(tmp_path)
    assert [fault.file for fault in caught.value.faults] == [tmp_path]


def test_a_missing_folder_and_a_file_are_refused(tmp_path: Path) -> None:
    with pytest.raises(CatalogueError, match=r"nowhere: there is no such folder$"):
        load_catalogue(tmp_path / "nowhere")
    (tmp_path / "arm.toml").write_text(VALID, encoding="utf-8")
    with pytest.raises(CatalogueError, match=r"arm\.toml: is no folder$"):
        load_catalogue(tmp_path / "arm.toml")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no such files on this system")
@pytest.mark.timeout(ANSWER)
def test_pipes_and_devices_are_refused_without_waiting(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "endless.toml").symlink_to("/dev/zero")
    (tmp_path / "terminal.toml").symlink_to("/dev/null")
    with pytest.raises(CatalogueError) as caught:
        load_catalogue(tmp_path)
    names = ["endless", "pipe", "terminal"]
    assert [fault.file.stem for fault in caught.value.faults] == names
    assert {fault.reason for fault in caught.value.faults} == {
        "cannot be read: it is a pipe or device"
    }


def test_a_file_that_is_too_large_is_refused(tmp_path: Path) -> None:
    with (tmp_path / "large.toml").open("wb") as file:
        file.truncate(10**10)
    with pytest.raises(CatalogueError, match=r"larger than 1024 KiB"):
        load_catalogue(tmp_path)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CatalogueError, match=r"nothing\.toml: cannot be read: No such file"):
        load_exercise(tmp_path / "nothing.toml")


def test_a_folder_instead_of_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(CatalogueError, match=r"folder\.toml: cannot be read"):
        load_exercise(tmp_path / "folder.toml")


def test_a_file_that_is_not_utf_8_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "latin.toml"
    file.write_bytes(VALID.replace("An arm", "Ein Gerät").encode("latin-1"))
    with pytest.raises(CatalogueError, match=r"latin\.toml: is not UTF-8"):
        load_exercise(file)


def test_all_faults_of_all_files_are_reported_together(tmp_path: Path) -> None:
    write(tmp_path, VALID, "good.toml")
    write(tmp_path, changed(("[0.3, 0.9]", "[0.9, 0.3]")), "reversed.toml")
    write(tmp_path, changed(('"An arm"', "5"), ("points = 4", "points = 0")), "two.toml")
    with pytest.raises(CatalogueError) as caught:
        load_catalogue(tmp_path)
    found = [(fault.file.name, fault.field) for fault in caught.value.faults]
    assert found == [
        ("reversed.toml", "symbols.a1.range"),
        ("two.toml", "title"),
        ("two.toml", "parts[1].points"),
    ]


@pytest.mark.parametrize(
    "change",
    [
        ('title = "An arm"', '# a comment\ntitle = "An arm"  # and another'),
        ('title = "An arm"', "title = 'An arm'"),
        ("points = 4", "points   =   4.0"),
        ("\n[symbols]", "\n\n\n[symbols]"),
        ('a1 = { kind = "length", range', 'a1 = { kind = "length",   range'),
    ],
)
def test_comments_and_layout_do_not_change_the_version(
    change: tuple[str, str], tmp_path: Path
) -> None:
    before = load_exercise(write(tmp_path, VALID)).version
    assert load_exercise(write(tmp_path, changed(change))).version == before


@pytest.mark.parametrize(
    "change",
    [
        ('"An arm"', '"The arm"'),
        ('"Two joints."', '"Two joints!"'),
        ('"90deg"', '"-90deg"'),
        ("[0.3, 0.9]", "[0.3, 0.8]"),
        ('"a length"', '"the length"'),
        ("points = 4", "points = 5"),
        ('convention = "standard"\n\n', 'convention = "modified"\n\n'),
        ("points = 4", "points = 4\nmarking = 'whole'"),
    ],
)
def test_content_changes_the_version(change: tuple[str, str], tmp_path: Path) -> None:
    before = load_exercise(write(tmp_path, VALID)).version
    assert load_exercise(write(tmp_path, changed(change))).version != before


def test_the_joints_of_a_wrist_may_begin_at_four(tmp_path: Path) -> None:
    text = changed(
        ('"theta1", "d2"]', '"theta4", "d5"]'), ("theta1 + pi", "theta4 + pi"), ("d2 + a1", "d5")
    )
    exercise = load_exercise(write(tmp_path, text))
    assert [joint.index for joint in exercise.robot.joints] == [4, 5]
    assert [reference.labels for reference in exercise.robot.tables.values()] == [
        ("4", "5"),
        ("4", "5"),
    ]


def test_ranges_may_be_formulas_of_constants(tmp_path: Path) -> None:
    text = changed(
        (
            "k = {",
            'theta1 = { kind = "angle", range = ["-pi/2", "90deg"], description = "j" }\nk = {',
        )
    )
    [theta, *_] = load_exercise(write(tmp_path, text)).variables
    assert (theta.low, theta.high) == pytest.approx((-1.5707963267948966, 1.5707963267948966))
    assert theta.joint == 1


def test_every_row_of_a_robot_can_be_handed_in(tmp_path: Path) -> None:
    # A robot that loads has no table longer than the twelve rows that an answer may have.
    names = [f"q{i}" for i in range(1, 12)]
    joints = [f'["k", "60deg", "0", "{name}"]' for name in names]
    table = ", ".join([*joints, '["k", "0", "k", "0"]'])
    start, end = VALID.index("table = ["), VALID.index("\n[symbols]")
    text = VALID[:start] + f"table = [{table}]\n" + VALID[end:]
    text = text.replace('"RP"', f'"{"R" * 11}"').replace('["theta1", "d2"]', str(names))
    try:
        exercise = load_exercise(write(tmp_path, text))
    except CatalogueError:
        return
    for reference in exercise.robot.tables.values():
        assert len(reference.rows) <= 12
        assert len(set(reference.labels)) == len(reference.labels)
