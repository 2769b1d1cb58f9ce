"""Find symbol names in texts."""

import json
import time
from pathlib import Path

import pytest
from dh_grader.expressions import characters as greek
from dh_grader.typeset import TypesetName, in_unicode, pieces, typeset

FILE = json.loads(Path(__file__).with_name("names.json").read_text(encoding="utf-8"))
SYMBOLS = frozenset(FILE["symbols"])


def shown(piece: str | TypesetName) -> str:
    if isinstance(piece, str):
        return piece
    return f"<{greek.LETTERS.get(piece.stem, piece.stem)}|{piece.below}|{piece.above}>"


@pytest.mark.parametrize(("text", "expected"), FILE["cases"])
def test_names_are_found_in_a_text(text: str, expected: str) -> None:
    assert "".join(map(shown, pieces(text, SYMBOLS))) == expected


def test_a_name_is_mathml_and_the_rest_is_escaped() -> None:
    assert typeset("<b> theta1 in {0}: R_2^0") == (
        "&lt;b&gt; <math><msub><mi>θ</mi><mn>1</mn></msub></math> in "
        '<span class="maths"><math><mrow><mo stretchy="false">{</mo><mn>0</mn>'
        '<mo stretchy="false">}</mo></mrow></math>:</span>'
        " <math><msubsup><mi>R</mi><mn>2</mn><mn>0</mn></msubsup></math>"
    )


def test_a_title_has_letters_and_lowered_digits() -> None:
    assert (
        in_unicode("An arm with theta1, d12 and z_i in {0}") == "An arm with θ₁, d₁₂ and z_i in {0}"
    )


@pytest.mark.parametrize("run", ["(", "[−", "1"])
def test_a_long_run_of_signs_takes_linear_time(run: str) -> None:
    began = time.process_time()
    typeset(run * 20_000)
    # It took 1.4 to 26 s in quadratic time; it takes some milliseconds.
    assert time.process_time() - began < 1
