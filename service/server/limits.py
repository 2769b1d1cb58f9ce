"""What one process takes from its clients, each number with its reason."""

from typing import Final

# Everything of a request that is not its content: the head, the sizes of chunks, the trailers.
# Browsers send 1 to 4 kB, proxies with large cookies 16.
MAX_FRAME: Final = 64 * 1024
# The longest address of this service has less than 200 characters.
MAX_URL: Final = 8 * 1024
MAX_HEADERS: Final = 100

# Seconds from the first byte of a request to its last, for the client to take an answer, and
# between two requests of a connection. 256 KiB in 30 s is 9 kB/s, which the slowest mobile line
# reaches.
PATIENCE: Final = 30.0
# Seconds from the opening of a connection to the first byte of its first request, and from the
# first byte of a head to its last. A head is one packet or a few.
HEAD_PATIENCE: Final = 10.0
# Seconds in which a client that was refused while it was still sending may read why.
LINGER: Final = 2.0
# What is read of it meanwhile, and thrown away.
MAX_DISCARDED: Final = 2 * 1024 * 1024
# Seconds between two looks at the clock.
SWEEP: Final = 0.5

# About 20 kB of memory each. When there are as many, those that keep the process waiting make room.
MAX_CONNECTIONS: Final = 1000
# Beyond them, where all are being answered: room for questions about the service's health.
RESERVE: Final = 32
# Files that the program itself opens.
OTHER_FILES: Final = 64
# Bytes of an answer that wait to be sent until no more of it is asked for: a longer answer that has
# been made in one piece counts as held by its client, as an unfinished request does.
MAX_UNREAD: Final = 16 * 1024
# Bytes of requests that have not arrived whole, and of answers that are not read, of all
# connections.
MAX_UNFINISHED: Final = 32 * 1024 * 1024

# From the signal to end until the last answers are given up.
GRACE: Final = 8.0
# Seconds beyond it until the process ends, whatever a thread of it is at.
LAST: Final = 1.3
# Where a supervisor asks; these wait for nobody.
HEALTH: Final = frozenset({"/healthz", "/readyz"})
