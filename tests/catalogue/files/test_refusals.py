"""Test the messages about unknown values in an exercise file."""

from pathlib import Path

import pytest
from dh_grader.catalogue import CatalogueError, load_exercise
from dh_grader.catalogue.kinds import SPECS

from tests.catalogue.test_faults import VALID, write

*_FIRST, _LAST = map(repr, sorted(SPECS))
KINDS = f"{', '.join(_FIRST)} or {_LAST}"
CONVENTIONS = "'standard', 'modified' or 'either'"
FRAMES = "'base' or 'tool', or input should be a valid integer"
SEQUENCES = (
    "'RPY', 'XYZ', 'XZY', 'YXZ', 'YZX', 'ZXY', 'ZYX', 'XYX', 'XZX', 'YXY', 'YZY', 'ZXZ' or 'ZYZ'"
)
TABLE = 'kind = "dh_table"'
POSE = 'kind = "transform"'


def told(tmp_path: Path, text: str) -> list[tuple[str, str]]:
    with pytest.raises(CatalogueError) as caught:
        load_exercise(write(tmp_path, text))
    return [(fault.field, fault.reason) for fault in caught.value.faults]


@pytest.mark.parametrize(
    ("old", "new", "field", "reason"),
    [
        (TABLE, 'kind = "dh_tabel"', "parts[0].kind",
         f"is 'dh_tabel'; did you mean 'dh_table'? Write {KINDS}"),
        (TABLE, 'kind = "DH_Table"', "parts[0].kind",
         f"is 'DH_Table'; did you mean 'dh_table'? Write {KINDS}"),
        (TABLE, 'kind = "quiz"', "parts[0].kind", f"is 'quiz'; write {KINDS}"),
        (TABLE, "kind = 3", "parts[0].kind", f"is 3; write {KINDS}"),
        (TABLE, f'kind = "{"x" * 500}"', "parts[0].kind",
         f"is 'xxxxxxxxxxxx...xxxxxxxxxxxxx'; write {KINDS}"),
        (POSE, 'kind = "euler_angles"\nsequence = "zyZ"', "parts[1].sequence",
         f"is 'zyZ'; did you mean 'ZYZ'? Write {SEQUENCES}"),
        ('k = { kind = "number"', 'k = { kind = "nummber"', "symbols.k.kind",
         "is 'nummber'; did you mean 'number'? Write 'angle', 'length' or 'number'"),
        # One fault, although pydantic has a finding for each type.
        ('convention = "standard"\n\n[[parts]]', 'convention = "standart"\n\n[[parts]]',
         "parts[0].convention",
         f"is 'standart'; did you mean 'standard'? Write {CONVENTIONS}"),
        (POSE, f'{POSE}\nfrom = "bas"', "parts[1].from",
         f"is 'bas'; did you mean 'base'? Write {FRAMES}"),
        ('["0", "0", "d2 + a1"', '["0", [], "d2 + a1"', "robot.table[1][1]",
         "Input should be a valid string, or input should be a valid number"),
    ],
)  # fmt: skip
def test_an_unknown_value_gets_a_suggestion(
    old: str, new: str, field: str, reason: str, tmp_path: Path
) -> None:
    assert VALID.count(old) == 1
    assert told(tmp_path, VALID.replace(old, new)) == [(field, reason)]


def test_all_faults_of_a_file_are_reported_together(tmp_path: Path) -> None:
    text = VALID.replace(TABLE, 'kind = "tabel"').replace("points = 4", 'points = "four"')
    assert [field for field, _ in told(tmp_path, text)] == ["parts[0].kind", "parts[1].points"]


def test_a_symbol_may_have_the_name_of_a_pydantic_type(tmp_path: Path) -> None:
    text = VALID.replace("[symbols]", "[symbols]\nfloat = 3")
    assert [field for field, _ in told(tmp_path, text)] == ["symbols.float"]
