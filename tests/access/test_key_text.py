import re

import pytest

from service.access.key_text import is_spelt_right, new_key_text


def test_a_key_is_random_and_spelt_right() -> None:
    keys = {new_key_text() for _ in range(100)}
    assert len(keys) == 100
    assert all(re.fullmatch(r"dhg_[0-9A-Za-z]{38}", key) for key in keys)
    assert all(map(is_spelt_right, keys))


def test_every_wrong_or_swapped_character_is_detected() -> None:
    key = new_key_text()
    for i in range(len(key)):
        for other in "a0Z_θ ":
            assert is_spelt_right(key[:i] + other + key[i + 1 :]) is (key[i] == other)
    swapped = [key[:i] + key[i + 1] + key[i] + key[i + 2 :] for i in range(4, len(key) - 1)]
    assert not any(is_spelt_right(each) for each in swapped if each != key)


@pytest.mark.parametrize("text", ["", "dhg_", "dhg_" + 38 * "0", 42 * "a", "a.b.c"])
def test_other_texts_are_not_keys(text: str) -> None:
    assert not is_spelt_right(text)
