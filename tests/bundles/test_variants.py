"""A bundle for a grading platform always gives a student the same variant."""

import json
from pathlib import Path

import pytest
from dh_grader.bundles import DRAWN, BundleVariants, UnknownStudentError, platform_seeds
from dh_grader.cli import program
from typer.testing import CliRunner

from tests.variants.varied_files import varied_text

VARIANTS = BundleVariants("s" * 64, {"reach": ["a", "b", "c"], "wrist": []})


def seeds(folder: Path, submission: object) -> dict[str, str]:
    described, variants = folder / "described.json", folder / "variants.json"
    described.write_text(json.dumps(submission), encoding="utf-8")
    variants.write_bytes(VARIANTS.file().content)
    return dict(platform_seeds(described, variants))


def users(*numbers: object) -> object:
    return {"id": 5, "users": [{"id": each, "email": "a@b.c", "name": "A"} for each in numbers]}


def test_a_student_always_gets_the_same_seeds_and_others_get_others(tmp_path: Path) -> None:
    found = [seeds(tmp_path, users(number)) for number in range(100, 140)]
    assert found[0] == seeds(tmp_path, users(100)) == VARIANTS.seeds_of("100")
    assert {each["reach"] for each in found} == {"a", "b", "c"}
    assert len({each["wrist"] for each in found}) == 40
    # Another name or address of the account changes nothing.
    renamed = {"users": [{"id": 100, "email": "x@y.z", "name": "B"}]}
    assert seeds(tmp_path, renamed) == found[0]


def test_a_group_has_the_variants_of_one_member(tmp_path: Path) -> None:
    assert seeds(tmp_path, users(9, 10)) == seeds(tmp_path, users(10, 9)) == VARIANTS.seeds_of("9")


def test_another_secret_gives_other_seeds() -> None:
    other = BundleVariants("t" * 64, VARIANTS.deployed)
    assert other.seeds_of("1")["wrist"] != VARIANTS.seeds_of("1")["wrist"]
    assert not set(other.some("wrist")) & set(VARIANTS.some("wrist"))
    assert len(set(VARIANTS.some("wrist"))) == DRAWN
    assert VARIANTS.some("reach") == ["a", "b", "c"]


def test_prairielearn_has_chosen_the_seeds(tmp_path: Path) -> None:
    assert seeds(tmp_path, {"variant_seed": 7, "params": {"seeds": {"reach": "b"}}}) == {
        "reach": "b"
    }


@pytest.mark.parametrize("described", [{}, [], users(), users("1"), users(None, 1), {"params": {}}])
def test_a_submission_of_nobody_is_refused(described: object, tmp_path: Path) -> None:
    with pytest.raises(UnknownStudentError, match="does not say whose submission it is"):
        seeds(tmp_path, described)
    with pytest.raises(UnknownStudentError, match="cannot be read"):
        platform_seeds(tmp_path / "missing.json", None)


ASSIGNMENT = 'title = "Arms"\nvariants = true\n[[exercises]]\npath = "arm.toml"\n'
NEEDS = {
    "bundle gradescope --output x.zip": "name a file for their secret, --secret F",
    "bundle gradescope --output x.zip --secret hw.toml": "hw.toml: contains no secret",
    "bundle gradescope --output x.zip --secret no/secret": "no/secret cannot be written",
    "bundle ci --output x.zip": "a job does not know whose files it grades",
    "grade arm.json": "Each student has variants of their own in this assignment.",
    "grade arm.json --platform-data arm.json": "arm.json does not say whose submission it is",
}


@pytest.mark.parametrize("command", NEEDS)
def test_a_command_says_what_variants_need(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("arm.toml").write_text(varied_text(), encoding="utf-8")
    Path("hw.toml").write_text(ASSIGNMENT, encoding="utf-8")
    Path("arm.json").write_text("{}", encoding="utf-8")
    done = CliRunner().invoke(program, [*command.split(), "--assignment", "hw.toml"])
    assert (done.exit_code, NEEDS[command] in done.output) == (2, True), done.output
    assert not Path("x.zip").exists()
