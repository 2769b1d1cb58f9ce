"""Catalogue, grading and solutions have the same kinds of answers."""

import sys
from types import ModuleType

import pytest

from service.catalogue import parts
from service.catalogue.parts import SPECS, KindError
from service.grading.kinds import KINDS
from service.kinds_check import check_kinds, require_complete
from service.solutions.kinds import ANSWERS


def test_the_three_registries_agree() -> None:
    assert list(SPECS) == sorted(KINDS) == list(ANSWERS)
    check_kinds()


def test_missing_files_of_a_kind_are_named() -> None:
    found = {"parts": {"matrix", "gear"}, "kinds": {"matrix"}, "answers": {"matrix", "cam"}}
    with pytest.raises(KindError) as error:
        require_complete(found)
    assert str(error.value).splitlines() == [
        "The answer kind 'cam' is incomplete: write parts/cam.py, kinds/cam.py.",
        "The answer kind 'gear' is incomplete: write kinds/gear.py, answers/gear.py.",
    ]


def test_a_file_without_its_class_is_refused() -> None:
    gear = ModuleType("service.catalogue.parts.gear")
    gear.__file__ = "parts/gear.py"
    with pytest.raises(KindError, match=r'parts/gear\.py: write one subclass .* Literal\["gear"\]'):
        parts._spec(gear)
    assert "service.catalogue.parts.gear" not in sys.modules
