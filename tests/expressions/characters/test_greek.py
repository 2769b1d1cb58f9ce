"""Read Greek letters and their names."""

from dh_grader.expressions import Symbol, Vocabulary, read


def test_a_greek_letter_is_not_replaced_by_its_name_inside_a_word() -> None:
    vocabulary = Vocabulary([Symbol(name, "number") for name in ("b", "eta", "beta")])
    assert read("bη", vocabulary).tree == read("b*eta", vocabulary).tree
    assert read("β", vocabulary).tree == read("beta", vocabulary).tree
