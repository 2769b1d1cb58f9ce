"""Test variants of exercises."""

import hashlib
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
import pytest
from dh_grader.catalogue import CatalogueError, Exercise
from dh_grader.catalogue.varying import read_condition, vocabulary_of
from dh_grader.figures import exercise_figure
from dh_grader.grading import Submission, grade
from dh_grader.submissions.bodies import UnknownExerciseError, find_exercise
from dh_grader.variants import (
    BuiltVariants,
    NoVariantError,
    built,
    choices_of,
    hidden_variant,
    pinned,
    seed_of,
)
from dh_grader.variants.deployment import Form, checked_variant, difficulty_of, form_of

from tests.together import together
from tests.variants.varied_files import VARIED, VARY, shipped, varied, varied_text

# --- Test variants of an exercise

FREE = VARY.replace("conditions", "#")
SEEDS = [str(i) for i in range(60)]


def numbers(statement: str) -> list[float]:
    return [float(each) for each in re.findall(r"(\d\.\d+) m", statement)]


def test_without_a_seed_an_exercise_has_the_first_choices() -> None:
    exercise = varied()
    assert exercise.title == "An arm with links of 0.3 m and 0.2 m"
    assert exercise.id == exercise.plain_id == "arm"
    assert not exercise.seed


def test_without_a_seed_other_choices_come_if_the_first_do_not_meet_the_conditions() -> None:
    exercise = varied(VARY.replace("a1 > a2", "a1 = a2"))
    first, second, _ = numbers(exercise.statement)
    assert first == second
    assert first in (0.3, 0.4)


def test_all_texts_of_a_variant_have_its_values_and_meet_the_conditions() -> None:
    exercise = varied()
    seen = set()
    for seed in SEEDS:
        variant = built(exercise, seed)
        a1, a2, both = numbers(variant.statement)
        down = "points down" in variant.statement
        assert a1 > a2
        assert a1 + a2 == pytest.approx(both)
        assert both <= 0.8 + 1e-9
        assert variant.title == f"An arm with links of {a1:g} m and {a2:g} m"
        assert "frame {0}" in variant.statement
        assert r"$\frac{a1}{2}$" in variant.statement
        table = variant.robot.tables[variant.robot.convention]
        [[a, alpha, *_], [second, *_]] = table.values({"theta1": [0.0], "theta2": [0.0]}, 1)  # type: ignore[dict-item]
        assert (a[0], second[0]) == (a1, a2)
        assert alpha[0] == pytest.approx(-1.5707963 if down else 1.5707963)
        seen.add((a1, a2, down))
    # 14 pairs of lengths meet the conditions, each with both directions.
    assert {each[0] for each in seen} == {0.3, 0.4, 0.5}
    assert {each[2] for each in seen} == {True, False}
    assert len(seen) > 15


def test_a_choice_follows_from_the_sha_256_of_id_seed_and_name() -> None:
    exercise = varied(
        "a1 = [1, 2, 3, 4, 5, 6, 7]\na2 = [1, 2]\nj2 = [{sign='', says='a'}, {sign='-', says='b'}]"
    )
    for seed in SEEDS:
        digest = hashlib.sha256(f"arm~{seed}/0/a1".encode()).hexdigest()
        assert f"links have {int(digest[:16], 16) % 7 + 1} m" in built(exercise, seed).statement


def test_another_name_leaves_the_values_of_the_others() -> None:
    one, two = varied(FREE), varied(FREE + "extra = [1, 2, 3]")
    assert all(built(one, seed).title == built(two, seed).title for seed in SEEDS)


def test_variants_are_the_same_in_every_process() -> None:
    code = (
        "from tests.variants.varied_files import varied\n"
        "from dh_grader.variants import built\n"
        "e = varied()\n"
        "print([(v.version, v.statement) for v in (built(e, str(i)) for i in range(40))])"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "4242"}
    ran = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, check=True, text=True
    )
    exercise = varied()
    here = [(v.version, v.statement) for v in (built(exercise, str(i)) for i in range(40))]
    assert ran.stdout.strip() == str(here)


def test_a_version_is_that_of_the_file_and_the_values() -> None:
    exercise = varied()
    versions = {built(exercise, seed).version for seed in SEEDS}
    titles = {built(exercise, seed).statement for seed in SEEDS}
    assert len(versions) == len(titles)
    assert {each.partition("-")[0] for each in versions} == {exercise.version.partition("-")[0]}
    deployed = varied(VARY + 'deployed = ["a", "b"]')
    assert deployed.version == exercise.version
    assert varied(VARY.replace("0.05", "0.1")).version.split("-")[0] not in exercise.version


def test_earlier_choices_keep_the_values_in_a_corrected_file() -> None:
    exercise = varied()
    corrected = varied(
        VARY.replace("[0.3, 0.4, 0.5]", "[0.7, 0.9]").replace("<= 0.8", "<= 2")
        + 'new = ["5deg + ", "6deg + "]',
        more="{{new}}",
    )
    kept = json.dumps(choices_of({"arm": exercise, "plain": replace(exercise, vary=None)}))
    # The texts need a name that was not there: it has the new choices.
    fitted = pinned(corrected, kept)
    assert {built(fitted, seed).title for seed in SEEDS} == {
        built(exercise, seed).title for seed in SEEDS
    }
    for seed in SEEDS:
        variant = built(fitted, seed)
        assert variant.title == built(exercise, seed).title
        assert variant.version.partition("-")[0] == corrected.version.partition("-")[0]
    # A new name that no text needs changes nothing at all.
    unused = varied(VARY + "new = [1, 2]")
    assert built(pinned(unused, kept), "1").version[-8:] == built(exercise, "1").version[-8:]
    # Groups without a field that the texts need do not fit: the new choices count.
    tilted = VARY.replace('"up"', '"up", tilt = ""').replace('"down"', '"down", tilt = "1deg + "')
    other = varied(tilted, more="{{j2.tilt}}")
    assert pinned(other, kept) is other
    assert pinned(exercise, None) is pinned(exercise, kept) is exercise


def _catalogue() -> dict[str, Exercise]:
    exercise = varied()
    return {"arm": exercise, "plain": replace(exercise, id="plain", vary=None)}


def test_an_id_with_a_seed_finds_the_variant() -> None:
    catalogue = _catalogue()
    found = find_exercise(catalogue, "arm~x7")
    assert (found.id, found.plain_id, found.seed) == ("arm~x7", "arm", "x7")
    assert found.statement == built(catalogue["arm"], "x7").statement


_BAD_SEED = "The seed of a variant has 1 to 20 small letters and digits."
REFUSED = {
    "plain~1": "The exercise plain has no variants.",
    "arm~": _BAD_SEED,
    "arm~A": _BAD_SEED,
    "arm~1~2": _BAD_SEED,
    "arm~" + "1" * 21: _BAD_SEED,
    "rm~1": "There is no exercise 'rm'. Did you mean 'arm'?",
}


@together(("name", "message"), REFUSED.items())
def test_an_id_with_a_wrong_seed_or_exercise_is_refused(name: str, message: str) -> None:
    with pytest.raises(UnknownExerciseError) as caught:
        find_exercise(_catalogue(), name)
    assert str(caught.value) == message


def test_a_hidden_variant_has_the_id_of_the_exercise() -> None:
    exercise = varied()
    hidden = hidden_variant(exercise, "secret7")
    assert hidden.id == "arm"
    assert hidden.statement == built(exercise, "secret7").statement


def test_only_the_variants_that_were_used_last_are_kept() -> None:
    variants = BuiltVariants(most=3)
    exercise = varied()
    first = variants.get(exercise, "0")
    for seed in ("1", "2"):
        variants.get(exercise, seed)
    assert variants.get(exercise, "0") is first
    variants.get(exercise, "3")
    assert len(variants) == 3
    assert variants.get(exercise, "0") is first
    assert variants.get(varied(), "0") is not first
    with pytest.raises(NoVariantError):
        variants.get(exercise, "NO")
    assert len(variants) == 3


FAULTS = {
    "a1 = [0.3]\n": "arm.toml: vary.a1 (line 10): has one value; write 2 to 1000",
    "a1 = 3\n": "vary.a1 (line 10): is not a list; write a list of choices, such as [0.3,",
    "a1 = [0.3, true]\n": "vary.a1[1] (line 10): must be a number or a text",
    "a1 = [0.3, nan]\n": "vary.a1[1] (line 10): is too large; write a number up to 1e9",
    "a1 = { from = 1, to = 2 }\n": "vary.a1 (line 10): needs step;",
    "a1 = { from = 2, to = 1, step = 1 }\n": "vary.a1 (line 10): must rise",
    "a1 = { from = 0, to = 1, step = 1e-9 }\n": "vary.a1.step (line 10): has 1,000,000,001 values;",
    "a1 = { from = 0, to = 1, by = 1 }\n": "vary.a1.by (line 10): there is no such key; a range",
    "a1 = [{ x = 1 }, { y = 1 }]\n": "vary.a1[1] (line 10): must have the same keys",
    '"a 1" = [1, 2]\n': "is no name; write letters and digits, such as a1",
    "pi = [1, 2]\n": "vary.pi (line 10):",
    "": "vary (line 9): varies nothing; write a list of choices",
    'a1 = [1, 2]\nconditions = ["a1"]': "vary.conditions[0] (line 11): must compare two formulas",
    'a1 = [1, 2]\nconditions = ["a1 < b"]': "vary.conditions[0] (line 11): This exercise has no",
    'a1 = [1, 2]\nconditions = ["a1 > 2"]': "vary.conditions (line 11): no one of 256 draws meets",
    'a1 = [1, 2]\nconditions = "a1 > 0"': "vary.conditions (line 11): must be a list of texts",
    'a1 = [1, 2]\nconditions = ["__import__(1) > 0"]': "vary.conditions[0] (line 11):",
    'a1 = [1, 2]\ndeployed = ["A"]': "vary.deployed[0] (line 11): is no seed; write 1 to 20 small",
    'a1 = [1, 2]\ndeployed = ["a", "a"]': "vary.deployed[1] (line 11): a is there twice",
    "b = [1, 2]": "title (line 2): ",
}


@together(("vary", "fault"), FAULTS.items())
def test_faults_of_the_table_vary_are_reported_with_their_places(vary: str, fault: str) -> None:
    with pytest.raises(CatalogueError) as caught:
        varied(vary)
    assert fault in str(caught.value)


IN_BRACES = {
    "{{j2.word}}": "there is no {{j2.word}}; write one of j2.sign, j2.says",
    "{{j2}}": "there is no {{j2}}; write one of j2.sign, j2.says",
    "{{a3}}": "This exercise has no `a3`. It has a1, a2",
    "{{1/(a1 - 0.3)}}": "{{1/(a1 - 0.3)}} has no value",
}


@together(("more", "reason"), IN_BRACES.items())
def test_faults_in_double_braces_are_reported_where_they_are(more: str, reason: str) -> None:
    with pytest.raises(CatalogueError) as caught:
        varied(more=more)
    [fault] = caught.value.faults
    line = (
        varied_text(more=more).splitlines().index(f'    ["{{{{a2}}}}", "{more}0", "0", "theta2"],')
    )
    assert (fault.field, fault.line) == ("robot.table[1][1]", line + 1)
    assert reason in fault.reason


def test_conditions_compare_up_to_rounding() -> None:
    names = vocabulary_of(["a", "b"])
    values = {"a": np.array([0.1 + 0.2, 0.3, 0.4]), "b": np.array([0.3, 0.4, 0.3])}
    expected = {
        "a = b": [True, False, False],
        "a != b": [False, True, True],
        "a < b": [False, True, False],
        "a ≥ b": [True, False, True],
        "a <= b": [True, True, False],
        "a > b": [False, False, True],
    }
    for text, result in expected.items():
        assert read_condition("", text, names).holds(values, 3).tolist() == result
    for text in ("a/(b - b) >= 0", "sqrt(-a) != 1", "1/(a - a) != 1"):
        assert not read_condition("", text, names).holds(values, 3).any()


# --- All variants of a shipped exercise are sound and equally hard

# What students get wrong: a cell of the table, from its numbers to other ones.
SLIPS = {
    "an alpha forgotten": (1, "0"),
    "a length forgotten": (0, "0"),
    "a sign of theta": (3, "-({})"),
    "an offset too much": (2, "{} + 0.123"),
}


def sound(exercise: Exercise, seeds: range) -> None:
    checked = [checked_variant(exercise, str(seed)) for seed in seeds]
    faults = [(each.seed, remark.text) for each in checked for remark in each.remarks]
    assert not faults
    scores = {each.difficulty.score for each in checked}
    assert max(scores) <= 1.2 * min(scores)
    assert len({each.form for each in checked}) > 0.6 * len(checked)


@pytest.mark.parametrize("name", VARIED)
def test_variants_are_sound_different_and_equally_hard(name: str) -> None:
    sound(shipped(name), range(1, 3))


@pytest.mark.campaign
@pytest.mark.parametrize("name", VARIED)
def test_two_hundred_variants_are_sound_different_and_equally_hard(name: str) -> None:
    sound(shipped(name), range(1, 201))


@pytest.mark.parametrize("name", VARIED)
def test_statement_and_figure_suit_every_seed(name: str) -> None:
    exercise = shipped(name)
    figures = set()
    for seed in range(1, 11):
        variant = built(exercise, str(seed))
        assert "{{" not in variant.statement + variant.title
        assert not re.search(r"\d{4}", variant.statement), "an unrounded number"
        if seed <= 2:
            figures.add(exercise_figure(variant))
        lengths = re.findall(r"(\d\.\d+)\s+m\b", variant.statement)
        table = variant.robot.tables[variant.robot.convention]
        written = {cell.text() for row in table.rows for cell in row}
        # Each length of the statement is in the table, and each of the table in the statement.
        assert set(lengths) == {each for each in written if re.fullmatch(r"\d\.\d+", each)}
    assert len(figures) == 2


def slips(rows: list[list[str]]) -> Iterator[tuple[str, list[list[str]]]]:
    """Yield wrong tables with one slip, each with a description."""
    for i in range(len(rows)):
        for slip, (column, text) in SLIPS.items():
            wrong = [list(row) for row in rows]
            wrong[i][column] = text.format(wrong[i][column])
            if wrong[i][column] != rows[i][column]:
                yield f"{slip} in row {i}", wrong


def points(variant: Exercise, rows: list[list[str]]) -> float:
    report = grade(variant, Submission({"table": {"rows": rows}}))
    return next(part.points for part in report.parts if part.part == "table")


def alike(exercise: Exercise, seeds: Iterable[str]) -> None:
    earned: dict[tuple[object, ...], set[float]] = {}
    for seed in seeds:
        variant = built(exercise, seed)
        table = variant.robot.tables[variant.robot.convention]
        rows = [[cell.text() for cell in row] for row in table.rows]
        assert points(variant, rows) == variant.parts[0].points
        # Where joints slide or axes are parallel, the same change may be a free choice.
        kind = (variant.structure, difficulty_of(variant))
        for slip, wrong in slips(rows):
            earned.setdefault((*kind, slip), set()).add(points(variant, wrong))
    assert len(earned) >= 8
    assert all(len(each) == 1 for each in earned.values()), earned


@pytest.mark.parametrize("name", VARIED)
def test_equally_good_answers_earn_the_same_in_every_variant(name: str) -> None:
    alike(shipped(name), map(str, range(4)))


@pytest.mark.campaign
@pytest.mark.parametrize("name", VARIED)
def test_equally_good_answers_of_two_hundred_learners_earn_the_same(name: str) -> None:
    alike(shipped(name), [seed_of("secret", f"learner {i}", name, 0) for i in range(200)])


def test_two_variants_have_one_form_only_if_they_are_the_same() -> None:
    exercise = shipped("planar-rr-numbers")
    by_form: dict[Form, set[str]] = {}
    for seed in range(1, 60):
        variant = built(exercise, str(seed))
        text = " ".join(variant.statement.split())
        by_form.setdefault(form_of(variant), set()).add(text)
    assert len(by_form) > 40
    assert all(len(texts) == 1 for texts in by_form.values())
    texts = [text for each in by_form.values() for text in each]
    assert len(texts) == len(set(texts))
