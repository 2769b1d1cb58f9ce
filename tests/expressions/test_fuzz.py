"""Any text is read quickly, and always with the same result."""

import pytest
from dh_grader.expressions import LIMITS, ExpressionError, read
from hypothesis import given
from hypothesis import strategies as st

from tests.expressions.corpus_files import ROBOT
from tests.expressions.fuzzing import PIECES, hostile, outcome, seeds, texts
from tests.guards import STALL
from tests.together import together

HOSTILE = hostile()

formulas: st.SearchStrategy[str] = st.recursive(
    st.sampled_from(["q1", "θ₁", r"\theta_2", "l1", "2", "0.5", "π", "c12", "90°", "½", "d3*"]),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from([*"+-*/^·", " ", r"\cdot ", ".*", "**"]), inner).map(
            "".join
        ),
        st.tuples(st.sampled_from(["sin", "cos ", r"\tan", "√", "sin^2", "-"]), inner).map("".join),
        st.tuples(
            st.sampled_from(["(", r"\left(", "[", "{", "sin("]), inner, st.sampled_from(")]}")
        ).map("".join),
        st.tuples(inner, inner).map(lambda parts: rf"\frac{{{parts[0]}}}{{{parts[1]}}}"),
    ),
    max_leaves=15,
)


def _check(text: str) -> None:
    for degrees in (False, True):
        first, second = outcome(text, degrees=degrees), outcome(text, degrees=degrees)
        assert first.fingerprint == second.fingerprint
        # A garbage collection may slow one of the two.
        assert min(first.seconds, second.seconds) < STALL


@given(formulas)
def test_random_formulas_give_one_result(text: str) -> None:
    _check(text)


@pytest.mark.long
@given(st.lists(st.sampled_from(PIECES), max_size=25).map("".join) | st.text(max_size=60))
def test_random_texts_give_one_result(text: str) -> None:
    _check(text)


@given(st.sampled_from(seeds()), st.integers(0, 60), st.binary(max_size=6))
def test_mutated_cases_give_one_result(text: str, at: int, put: bytes) -> None:
    data = text.encode()
    _check((data[:at] + put + data[at + 1 :]).decode("utf-8", "replace"))


def test_a_sample_of_the_fuzz_campaign_gives_one_result() -> None:
    for text in texts(300, seed=1):
        _check(text)


@pytest.mark.long
@together("text", HOSTILE)
def test_hostile_texts_give_one_result(text: str) -> None:
    _check(text)


@pytest.mark.parametrize("text", [text for text in HOSTILE if "__" in text or "import" in text])
def test_program_code_is_refused(text: str) -> None:
    with pytest.raises(ExpressionError):
        read(text, ROBOT)


def test_a_text_that_is_too_long_is_refused_at_once() -> None:
    with pytest.raises(ExpressionError) as caught:
        read("(" * 10_000_000, ROBOT)
    assert (caught.value.code, caught.value.span[0]) == ("too_long", LIMITS.characters)
