"""docs/exercise-fields.md is up to date with the schema."""

import re
import tomllib
from pathlib import Path

import pytest
from dh_grader.catalogue.kinds import SPECS
from dh_grader.catalogue.part import PartSpec
from dh_grader.catalogue.schema import (
    CheckSpec,
    ExerciseSpec,
    ExpectSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
)
from dh_grader.catalogue.schema_fields import AttemptsSpec

from tests.docs.exercise_fields import page

FILE = Path(__file__).parents[2] / "docs" / "exercise-fields.md"
MODELS = (
    ExerciseSpec,
    AttemptsSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
    PartSpec,
    *SPECS.values(),
    CheckSpec,
    ExpectSpec,
)


def test_the_page_is_up_to_date() -> None:
    assert FILE.read_text(encoding="utf-8") == page(), (
        "The keys have changed; run python -m tests.docs.exercise_fields > docs/exercise-fields.md"
    )


def test_the_examples_are_toml() -> None:
    blocks = re.findall(r"```toml\n(.*?)```", page(), re.DOTALL)
    assert len(blocks) > len(SPECS)
    assert all(tomllib.loads(block) for block in blocks)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: str(model.__name__))
def test_every_key_has_its_meaning(model: type[PartSpec]) -> None:
    written = FILE.read_text(encoding="utf-8")
    for name, field in model.model_fields.items():
        key = field.alias or name
        assert f"| `{key}` |" in written or key == "kind"
