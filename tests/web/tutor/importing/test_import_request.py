"""The editor imports a URDF file as the command line does."""

from collections.abc import Mapping
from pathlib import Path

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.cli.exercises import exercises_commands as commands
from typer.testing import CliRunner

from tests.importing.test_pasted_robot import PASTED
from tests.importing.test_urdf import REFUSED, file_of
from tests.web.tutor.test_tutor_routes import Tutor


@pytest.fixture
def tutor(catalogue: Mapping[str, Exercise]) -> Tutor:
    return Tutor(catalogue)


@pytest.mark.long
def test_a_robot_is_imported_as_by_the_command(tutor: Tutor, tmp_path: Path) -> None:
    arm = file_of("panda")
    table = tmp_path / "pasted.txt"
    table.write_text(PASTED, encoding="utf-8")
    for file, kind, option in ((arm, "urdf", "--letters"), (table, "table", "--table")):
        source = f"Imported from a {'DH table' if kind == 'table' else 'URDF file'}"
        folder = tmp_path / kind
        named = ["--id", "arm", "--source", source, "--output", str(folder)]
        made = CliRunner().invoke(commands, ["import", str(file), option, *named])
        assert made.exit_code == 0, made.output
        body = {
            "kind": kind,
            "text": file.read_text(encoding="utf-8"),
            "id": "arm",
            "letters": file is arm,
        }
        answer = tutor.ask("POST", "/tutor/import", json=body)
        assert answer.json()["text"] == (folder / "arm.toml").read_text("utf-8")
        [finding] = tutor.check(answer.json()["text"], "arm")["findings"]
        assert finding["text"].startswith("1 right, 1 equivalent, 0 wrong")


@pytest.mark.long
@pytest.mark.parametrize("name", ["doctype", "loop", "nan", "xacro", "eleven joints", "deep"])
def test_a_hostile_file_is_refused_with_the_reason(tutor: Tutor, name: str) -> None:
    text, reason = REFUSED[name]
    body = {"kind": "urdf", "text": text.decode()[:200_000], "id": "arm", "tip": "l1"}
    if name == "loop":
        body["tip"] = "l2"
    elif name == "eleven joints":
        body["tip"] = "l11"
    answer = tutor.ask("POST", "/tutor/import", json=body)
    assert answer.status_code == 422
    assert reason in answer.json()["detail"]


def test_other_refusals_have_their_reasons(tutor: Tutor) -> None:
    table = {"kind": "table", "text": "good morning", "id": "arm"}
    assert tutor.ask("POST", "/tutor/import", json=table).status_code == 422
    named = tutor.ask("POST", "/tutor/import", json={**table, "text": PASTED, "id": "../arm"})
    assert "cannot be the id of an exercise" in named.json()["detail"]
    unknown = tutor.ask("POST", "/tutor/import", json={**table, "text": PASTED, "kind": "sdf"})
    assert unknown.status_code == 422


def test_refusals_are_told_in_the_language_of_the_reader(tutor: Tutor) -> None:
    for kind, text, said in (
        ("table", "a,alpha,d,theta\n1,0,0,0\n1,0,0,0\n", "Zeile 1 hat keine Gelenkvariable"),
        ("urdf", "<sdf/>", "Die Datei beginnt mit <sdf>, nicht mit <robot>."),
    ):
        body = {"kind": kind, "text": text, "id": "arm", "tip": "l1"}
        refused = tutor.ask("POST", "/tutor/import", json=body, params={"lang": "de"})
        assert refused.json()["detail"].startswith(said)


def test_what_a_table_leaves_open_is_asked_in_the_language_of_the_reader(tutor: Tutor) -> None:
    body = {"kind": "table", "text": "a,alpha,d,theta\n131.2,90,0,q1\n", "id": "arm"}
    asked = tutor.ask("POST", "/tutor/import", json=body, params={"lang": "de"}).json()
    unit, angles = asked["questions"]
    assert (asked["text"], unit["name"], angles["name"]) == ("", "unit", "angles")
    assert unit["text"].startswith("Die Tabelle nennt keine Längeneinheit.")
    assert (unit["choices"][2], angles["choices"]) == ("mm", ["degrees", "radians"])
    answered = {**body, "unit": "mm", "angles": "degrees", "order": "", "convention": None}
    made = tutor.ask("POST", "/tutor/import", json=answered).json()
    assert made["questions"] == []
    assert '["0.1312", "90deg", "0", "theta1"]' in made["text"]
