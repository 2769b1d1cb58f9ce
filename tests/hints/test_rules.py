"""Rules in hints never contain values from an exercise."""

import re
from gettext import NullTranslations
from string import Formatter
from xml.etree import ElementTree

import numpy as np
import pytest
from dh_grader import hints as picture
from dh_grader.figures.drawing import Theme
from dh_grader.grading.misconception import Record, all_records
from dh_grader.hints import OF_COLUMN, RULES, Rule, rule_picture
from dh_grader.kinematics import Convention, modified_link, standard_link
from dh_grader.translations import Language

from tests.together import together

RECORDS = [record for record in all_records() if record.codes]
FIELDS = {"row", "x", "z", "x_before", "x_here", "z_before", "axis", "entry"}
PICTURED = [name for name, rule in RULES.items() if rule.pictured]
SVG = "{http://www.w3.org/2000/svg}"


@together("record", RECORDS)
def test_each_record_has_a_rule(record: Record) -> None:
    assert record.rule == "of_column" or record.rule in RULES, record.name


@together("rule", list(RULES.values()))
def test_a_rule_names_only_places_and_axes(rule: Rule) -> None:
    for text in (rule.look, rule.apply):
        assert {field for _, field, *_ in Formatter().parse(text) if field} <= FIELDS
    for text in (rule.look, rule.apply, rule.statement, rule.modified):
        # No number but in indices and the angles of a full turn: it might be the value of a cell.
        assert not re.findall(r"(?<![a-z\d+-])\d+(?!\d|°|π)", text)


def test_each_column_has_its_own_picture() -> None:
    assert [RULES[name].pictured for name in OF_COLUMN.values()] == [(name,) for name in OF_COLUMN]


@pytest.mark.parametrize("convention", Convention)
def test_the_drawn_frames_follow_the_convention(convention: Convention) -> None:
    link = standard_link if convention is Convention.STANDARD else modified_link
    expected = link(picture._LENGTH, picture._TWIST, picture._OFFSET, picture._ANGLE)
    scene = picture._scene(convention)
    np.testing.assert_allclose(scene.after, expected[:3, [0, 2, 3]], atol=1e-12)
    for name, size in (("a", picture._LENGTH), ("d", picture._OFFSET)):
        first, last = scene.length(name)
        assert np.linalg.norm(last - first) == pytest.approx(size)
    for name in ("alpha", "theta"):
        _, axis, first, last = scene.angle(name)
        size = picture._TWIST if name == "alpha" else picture._ANGLE
        # By Rodrigues' formula, turning about the axis leads from the first direction to the last.
        turned = first * np.cos(size) + np.cross(axis, first) * np.sin(size)
        np.testing.assert_allclose(turned, last, atol=1e-12)


@pytest.mark.parametrize("convention", Convention)
def test_a_picture_names_the_axes_and_the_parameter(convention: Convention) -> None:
    for name in PICTURED:
        root = ElementTree.fromstring(rule_picture(name, convention, Theme.LIGHT))
        texts = ["".join(text.itertext()) for text in root.iter(f"{SVG}text")]
        assert {"zi−1", "xi−1", "zi", "xi"} <= set(texts)
        assert len(texts) == 4 + len(RULES[name].pictured)
        assert float(root.attrib["width"]) <= 352
    twist = rule_picture("link_twist", convention, Theme.LIGHT)
    assert ("αi−1" in re.sub(r"<[^>]+>", "", twist)) == (convention is Convention.MODIFIED)


class German(NullTranslations):
    """A German translation of a single title."""

    def gettext(self, message: str) -> str:
        return "Gliedlänge a" if message == "Link length a" else message


def test_the_text_alternative_of_a_picture_is_in_the_language() -> None:
    german = Language("de", "Deutsch", "de")
    german.__dict__["translation"] = German()
    drawn = rule_picture("link_length", Convention.STANDARD, Theme.LIGHT, german)
    assert [each.text for each in ElementTree.fromstring(drawn).iter(f"{SVG}title")] == [
        "Gliedlänge a"
    ]
    assert "z_{i-1}" in drawn
