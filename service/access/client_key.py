"""The client that an address belongs to, for turns, room and rates alike."""

import ipaddress


def client_key(address: str) -> str:
    """Return the client of an address: with IPv6 its /64 network, of which a client has all.

    An IPv4 address that an IPv6 socket has written as ``::ffff:10.0.0.7`` is the IPv4 address.
    """
    if ":" not in address:
        return address
    try:
        found = ipaddress.IPv6Address(address.partition("%")[0])
    except ValueError:
        return address
    if found.ipv4_mapped is not None:
        return str(found.ipv4_mapped)
    return str(ipaddress.IPv6Network((found, 64), strict=False))
