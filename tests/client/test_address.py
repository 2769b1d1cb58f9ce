import pytest
from dh_grader.client import checked_server, client_options


@pytest.mark.parametrize(
    ("server", "called"),
    [
        ("http://127.0.0.1:8000", "http://127.0.0.1:8000"),
        ("https://grader.example.edu/", "https://grader.example.edu"),
        ("https://example.edu:443/a/b/", "https://example.edu/a/b"),
        ("http://[::1]:8000", "http://[::1]:8000"),
    ],
)
def test_an_address_is_normalized(server: str, called: str) -> None:
    assert checked_server(server) == called


@pytest.mark.parametrize(
    "server",
    [
        "", "localhost:8000", "grader.example.edu", "ftp://example.edu", "http://", "http://x:y",
        "http://a b", "https://example.edu?a=b", "https://example.edu#a", "file:///etc",
    ],
)  # fmt: skip
def test_an_invalid_address_is_refused(server: str) -> None:
    with pytest.raises(ValueError, match="address of a server"):
        checked_server(server)


def test_a_password_in_an_address_is_refused_and_not_shown() -> None:
    with pytest.raises(ValueError, match="only scheme") as caught:
        checked_server("https://user:hunter2@example.edu")
    assert "hunter2" not in str(caught.value)


@pytest.mark.parametrize("key", ["", " ", "dhg 1", "dhg\r\nX-Admin: 1", "schlüssel", "dhg_\n"])
def test_a_key_with_invalid_characters_is_refused_and_not_shown(key: str) -> None:
    with pytest.raises(ValueError, match="The key is empty or") as caught:
        client_options("http://x", key, 1.0)
    assert not key.strip() or key.strip() not in str(caught.value)


def test_a_key_is_sent_in_the_authorization_header() -> None:
    options = client_options("http://x", "dhg_1", 1.0)
    assert options["headers"]["Authorization"] == "Bearer dhg_1"
    assert "Authorization" not in client_options("http://x", None, 1.0)["headers"]
