"""The limits that one process sets for its clients."""

from typing import Final

# Bytes of a request other than its content: the head, the sizes of chunks, the trailers. Browsers
# send 1 to 4 kB, proxies with large cookies 16.
MAX_FRAME: Final = 64 * 1024
# The longest address of this service has less than 200 characters.
MAX_URL: Final = 8 * 1024
MAX_HEADERS: Final = 100

# Seconds from the first byte of a request to its last, until the client reads an answer, and
# between two requests of a connection. 256 KiB in 30 s is 9 kB/s, which the slowest mobile line
# reaches.
TIMEOUT: Final = 30.0
# Seconds from the opening of a connection to the first byte of its first request, and from the
# first byte of a head to its last. A head is one packet or a few.
HEAD_TIMEOUT: Final = 10.0
# Seconds for a client that was refused while it was still sending to read the refusal.
LINGER: Final = 2.0
# Bytes of such a client that are read and discarded meanwhile.
MAX_DISCARDED: Final = 2 * 1024 * 1024
# Seconds between two checks for connections whose time is over.
SWEEP: Final = 0.5

# About 20 kB of memory each. Beyond this number, connections without a whole request are closed.
MAX_CONNECTIONS: Final = 1000
# Additional connections for health checks, while all others are being answered.
RESERVE: Final = 32
# Files that the program may have open besides its connections.
OTHER_FILES: Final = 64
# Unsent bytes of an answer after which the application is paused. The unsent bytes of a longer
# answer count towards the limit of unfinished requests.
MAX_UNREAD: Final = 16 * 1024
# Bytes of unfinished requests and of unread answers, in all connections together.
MAX_UNFINISHED: Final = 32 * 1024 * 1024

# Seconds from the signal to end until unfinished answers are given up.
GRACE: Final = 8.0
# Seconds after that until the process exits, even if a thread is still running.
FORCED_EXIT: Final = 1.3
# The paths of health checks, which are answered without waiting for a turn.
HEALTH: Final = frozenset({"/healthz", "/readyz"})
