"""Test the text of an API key: its characters and its checksum."""

import re
from zlib import crc32

import pytest
from dh_grader.access import is_spelt_right, key_text_of, new_key_text

DIGITS = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"


def test_a_key_is_random_and_spelt_right() -> None:
    keys = {new_key_text() for _ in range(100)}
    assert len(keys) == 100
    assert all(re.fullmatch(r"dhg_[0-9A-Za-z]{38}", key) for key in keys)
    assert all(map(is_spelt_right, keys))


def written(number: int, length: int) -> str:
    """Write a number in base 62, the lowest digit first."""
    return "".join(DIGITS[number // 62**i % 62] for i in range(length))


@pytest.mark.parametrize("number", [0, 1 + 2 * 62 + 61 * 62**2, 62**32 - 1, 62**32 + 7, 2**512 - 1])
def test_the_text_of_a_personal_link_stays_the_same(number: int) -> None:
    drawn = written(number, 32)
    text = f"dhg_{drawn}{written(crc32(drawn.encode()), 6)}"
    assert key_text_of(number.to_bytes(64, "big")) == text
    assert is_spelt_right(text)


def test_a_key_has_any_digit_and_letter() -> None:
    texts = "".join(new_key_text()[4:36] for _ in range(100))
    assert set(texts) == set(DIGITS)


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
