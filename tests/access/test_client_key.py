"""Identify a client by the address of its requests."""

import pytest
from dh_grader.access import client_key


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("10.0.0.1", "10.0.0.2", False),
        ("2001:db8:1:2::1", "2001:db8:1:2:ffff::9", True),
        ("2001:db8:1:2::1", "2001:db8:1:3::1", False),
        ("fe80::1%eth0", "fe80::2%eth0", True),
        ("::ffff:10.0.0.1", "10.0.0.1", True),
        ("::ffff:10.0.0.1", "::ffff:10.0.0.2", False),
        ("testclient", "testclient", True),
        ("no:address", "no:other", False),
    ],
)
def test_the_addresses_of_an_ipv6_network_are_one_client(one: str, other: str, same: bool) -> None:
    assert (client_key(one) == client_key(other)) is same


@pytest.mark.parametrize(
    ("address", "client"),
    [
        ("10.0.0.1", "10.0.0.1"), ("2001:db8:1:2:3::4%eth0", "2001:db8:1:2::/64"),
        ("::ffff:10.0.0.1", "10.0.0.1"), ("no:address", "no:address"), ("", ""),
    ],
)  # fmt: skip
def test_a_client_is_named_by_its_address_or_network(address: str, client: str) -> None:
    assert client_key(address) == client
