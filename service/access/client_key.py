"""The client of an address. Scheduling, connection limits and rate limits count by client."""

import ipaddress


def client_key(address: str) -> str:
    """Return the IPv4 address, or the /64 network of an IPv6 address: a client may own all of it.

    An IPv4 address in IPv6 notation, ``::ffff:10.0.0.7``, is returned as the IPv4 address.
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
