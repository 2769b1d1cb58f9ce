"""Test robots that are drawn for practice."""

import hashlib
import json
import os
import re
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from hashlib import sha256
from itertools import pairwise

import pytest
from dh_grader.catalogue import Exercise, in_language
from dh_grader.kinematics import Convention
from dh_grader.translations import ENGLISH, LANGUAGES
from dh_grader.variants.robot_geometry import Draws
from dh_grader.variants.robots import ALL_NUMBERS, PracticeId, generated, practice_id

from tests.translations.pseudo import PSEUDO
from tests.variants.robots.checks import (
    drawn,
    form,
    is_the_robot_of_its_statement,
    lazy_share,
    model_share,
    nearest_links,
    overlapping_labels,
)


def test_draws_are_the_words_of_a_hash() -> None:
    block = sha256(b"a robot\n0").digest()
    words = [int.from_bytes(block[i : i + 4], "big") for i in range(0, 32, 4)]
    draws = Draws("a robot")
    assert [draws.below(1000) for _ in words] == [word * 1000 // 2**32 for word in words]


def test_choices_follow_their_weights() -> None:
    draws = Draws("weights")
    found = [draws.weighted([("a", 3), ("b", 0), ("c", 1)]) for _ in range(4000)]
    assert "b" not in found
    assert 2850 < found.count("a") < 3150
    assert 350 < sum(draws.chance(10) for _ in range(4000)) < 450


# --- Practice id


@pytest.mark.parametrize("number", [0, 35, 36, 1295, 10**9, ALL_NUMBERS - 1])
def test_an_id_is_read_as_it_is_written(number: int) -> None:
    name = PracticeId(3, Convention.MODIFIED, number)
    assert practice_id(str(name)) == name
    assert int(name.seed, 36) == number


@pytest.mark.parametrize(
    "text",
    [
        "practice-2-standard", "practice-2-standard~", "practice-0-standard~a",
        "practice-5-standard~a", "practice-2-other~a", "practice-2-standard~01",
        "practice-2-standard~A", "practice-2-standard~123456789", "practice-2-standard~a\n",
        "practice-²-standard~a", "scara", "scara~a",
    ],
)  # fmt: skip
def test_other_texts_are_no_robots(text: str) -> None:
    assert practice_id(text) is None


def test_the_first_robot_follows_the_last_one() -> None:
    last = PracticeId(1, Convention.STANDARD, ALL_NUMBERS - 1)
    assert last.following().number == 0


# --- Check some generated robots

LEVELS = (1, 2, 3, 4)
JOINTS = {1: {2, 3}, 2: {3, 4}, 3: {4, 5, 6}, 4: {5, 6, 7}}
SAMPLE = 2
# Links to robots are shared, so a robot must never change: the digests of the first ones.
DIGEST = "bb8280642a5d676c"


def digest() -> str:
    seen = [
        (each.id, each.version, each.statement, each.summary, str(each.view))
        for level in LEVELS
        for convention in Convention
        for number in range(5)
        for each in [drawn(level, number, convention)]
    ]
    return hashlib.sha256(json.dumps(seen).encode()).hexdigest()[:16]


def test_robots_are_the_same_on_every_python() -> None:
    assert digest() == DIGEST


@pytest.mark.long
@pytest.mark.parametrize(
    "seed", ["1", *(pytest.param(each, marks=pytest.mark.campaign) for each in ("2", "3", "4"))]
)
def test_robots_are_the_same_with_every_hash_seed(seed: str) -> None:
    program = "from tests.variants.robots.test_robots import digest; print(digest())"
    environment = os.environ | {"PYTHONHASHSEED": seed}
    ran = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, check=True, text=True
    )
    assert ran.stdout.strip() == DIGEST


@pytest.mark.sampled(4)
@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("convention", Convention)
def test_the_statement_proves_itself_and_the_marks_are_fair(
    level: int, convention: Convention
) -> None:
    for number in range(100, 100 + SAMPLE):
        exercise = drawn(level, number, convention)
        assert len(exercise.joints) in JOINTS[level], exercise.id
        assert is_the_robot_of_its_statement(exercise, number), exercise.id
        assert model_share(exercise, solved=number == 100) == 1, exercise.id
        assert lazy_share(exercise) <= 0.25, exercise.id
        assert nearest_links(exercise) > 0.12, exercise.id


@pytest.mark.sampled(4)
@pytest.mark.parametrize("level", LEVELS)
def test_no_labels_of_a_figure_overlap(level: int) -> None:
    assert overlapping_labels(drawn(level, 77)) == []


@pytest.mark.parametrize(
    ("level", "count"),
    [
        *((level, 30) for level in LEVELS),
        *(pytest.param(level, 500, marks=pytest.mark.campaign) for level in LEVELS),
    ],
)
def test_no_two_of_the_first_robots_are_alike(level: int, count: int) -> None:
    assert len({form(drawn(level, number)) for number in range(count)}) == count


def test_a_statement_of_another_robot_is_noticed() -> None:
    exercise = drawn(2, 7)
    words = exercise.statement.replace("along z0", "opposite to z0", 1)
    assert not is_the_robot_of_its_statement(replace(exercise, statement=words), 1)
    assert form(exercise) != form(replace(exercise, statement=words))


def texts(exercise: Exercise) -> str:
    """Return everything that students read in an exercise."""
    return "\n".join([
        exercise.title, exercise.source, exercise.summary, exercise.statement,
        *(each.title for each in exercise.parts), *(each.prompt for each in exercise.parts),
        *(each.description for each in exercise.variables),
    ])  # fmt: skip


def words(text: str) -> set[str]:
    return set(re.findall(r"(?<!\w)[^\W\d_]{3,}(?!\w)", text))


def values(text: str) -> Counter[str]:
    return Counter(re.findall(r"-?(?<![A-Za-z])(?:[adhxyz]|theta)?\d+(?:\.\d+)?|\{\w\}", text))


@pytest.mark.parametrize("convention", Convention)
@pytest.mark.parametrize("level", LEVELS)
def test_all_texts_are_told_in_other_languages(level: int, convention: Convention) -> None:
    for number in range(100, 110):
        exercise = drawn(level, number, convention)
        english = texts(exercise)
        accented = texts(in_language(exercise, PSEUDO))
        assert words(english) & words(accented) <= {exercise.structure}, exercise.id
        for language in [PSEUDO, *LANGUAGES.values()]:
            assert values(texts(in_language(exercise, language))) == values(english), language
        german = texts(in_language(exercise, LANGUAGES["de"]))
        names = {exercise.structure, "Denavit", "Hartenberg", "Grader"}
        assert words(english) & words(german) <= names, exercise.id
        assert in_language(exercise, ENGLISH) is exercise


def test_a_robot_is_described_in_german() -> None:
    exercise = in_language(drawn(4, 3, Convention.MODIFIED), LANGUAGES["de"])
    assert exercise.title == "Übungsroboter 3, Stufe 4"
    assert exercise.summary == "Sieben Gelenke (RPPRRRR), Längen in Metern."
    for sentence in (
        "Der Roboter hat fünf Drehgelenke und zwei Schubgelenke (RPPRRRR). Alle Längen sind in",
        "- Gelenk 2 verschiebt sich längs der Richtung, die um 30° von -x0 zu z0 hin geneigt ist.",
        "\n- Gelenk 5 dreht um die Achse durch (0, -0.2 - 0.46, 0.54), längs x0.\n",
        "0.54), seine x-Achse zeigt entgegen y0 und seine z-Achse zeigt entgegen z0. Die Koord",
    ):
        assert sentence in exercise.statement


def test_the_hardest_level_has_odd_twists() -> None:
    for number in range(20):
        rows = generated(4, number).plan.rows
        assert any(row.alpha % 90 for row in rows)
        assert not any(
            first.sliding and second.sliding and first.alpha % 180 == 0
            for first, second in pairwise(rows)
        )
