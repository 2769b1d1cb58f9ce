"""The variants of an assignment are different and equally hard."""

import tomllib

import pytest
from dh_grader.variants import built
from dh_grader.variants.deployment import (
    TooFewVariantsError,
    deploy,
    difficulty_of,
    form_of,
    with_deployed,
)

from tests.variants.varied_files import VARY, shipped, varied, varied_text


def test_deployed_variants_are_different_and_equally_hard() -> None:
    exercise = shipped("planar-rr-numbers")
    seeds = deploy(exercise, 12)
    assert len(set(seeds)) == 12
    variants = [built(exercise, seed) for seed in seeds]
    assert len({form_of(each) for each in variants}) == 12
    assert len({difficulty_of(each).score for each in variants}) == 1


def test_seeds_of_equal_variants_are_left_out() -> None:
    # Two lengths: two variants, each drawn by many seeds.
    few = VARY.replace("{ from = 0.2, to = 0.6, step = 0.05 }", "[0.2, 0.2]")
    few = few.replace("[0.3, 0.4, 0.5]", "[0.3, 0.4]").replace('sign = "-"', 'sign = ""')
    exercise = varied(few)
    seeds = deploy(exercise, 2, seeds=map(str, range(10_000)))
    assert len({built(exercise, seed).title for seed in seeds}) == 2
    with pytest.raises(TooFewVariantsError, match="arm has only 2 different variants of one"):
        deploy(exercise, 3, seeds=map(str, range(10_000)))


def test_deployed_seeds_stay_and_struck_ones_are_replaced() -> None:
    first = deploy(varied(), 5, seeds=map(str, range(100)))
    again = varied(f"{VARY}deployed = {first}")
    assert deploy(again, 5) == first
    more = deploy(again, 7, seeds=map(str, range(100, 300)))
    assert more[:5] == first
    struck = deploy(again, 5, without=[first[1]], seeds=map(str, range(100, 300)))
    assert struck[:4] == [first[0], *first[2:]]
    assert first[1] not in struck


def test_the_seeds_are_written_into_the_file_and_nothing_else_changes() -> None:
    text = varied_text().replace("[vary]\n", "[vary]  # what varies\n") + "# the end\n"
    written = with_deployed(text, ["a", "b"])
    assert written is not None
    assert tomllib.loads(written)["vary"]["deployed"] == ["a", "b"]
    before, after = text.split("# what varies\n")
    assert written == f'{before}# what varies\ndeployed = [\n    "a", "b",\n]\n{after}'
    many = [f"s{i}" for i in range(20)]
    again = with_deployed(written, many)
    assert again is not None
    assert tomllib.loads(again)["vary"]["deployed"] == many
    assert with_deployed(again, ["a", "b"]) == written


def test_a_file_that_is_written_in_another_way_is_left_alone() -> None:
    inline = 'vary = { a1 = [1, 2] }\ntitle = "x"\n'
    assert with_deployed(inline, ["a"]) is None
    hidden = 'title = """\n[vary]\n"""\n[vary]\na1 = [1, 2]\n'
    assert with_deployed(hidden, ["a"]) is None
