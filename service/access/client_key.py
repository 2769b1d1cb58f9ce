"""Find the client of a request by its address, for scheduling and for limits."""

import ipaddress


def client_key(address: str) -> str:
    """Return the client of an address: the IPv4 address, or the /64 network of the IPv6 address."""
    # One client may own a whole /64 network. An IPv4 address in IPv6 notation, such as
    # ``::ffff:10.0.0.7``, counts as the IPv4 address.
    if ":" not in address:
        return address
    try:
        found = ipaddress.IPv6Address(address.partition("%")[0])
    except ValueError:
        return address
    if found.ipv4_mapped is not None:
        return str(found.ipv4_mapped)
    return str(ipaddress.IPv6Network((found, 64), strict=False))
