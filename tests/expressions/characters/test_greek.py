"""Greek letters and their names."""

from service.expressions import Symbol, Vocabulary, read


def test_greek_letters_are_not_spelled_out_inside_a_word() -> None:
    vocabulary = Vocabulary([Symbol(name, "number") for name in ("b", "eta", "beta")])
    assert read("bη", vocabulary).tree == read("b*eta", vocabulary).tree
    assert read("β", vocabulary).tree == read("beta", vocabulary).tree
