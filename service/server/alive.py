"""`python -m service.server.alive`: exit code 0 where the service of this machine answers.

The image asks it. Without the program itself, so that asking costs nothing.
"""

import os
from http.client import HTTPConnection, HTTPException


def main() -> int:
    """Ask /healthz where DH_GRADER_HOST and DH_GRADER_PORT say that the service listens."""
    host = os.environ.get("DH_GRADER_HOST", "127.0.0.1")
    port = int(os.environ.get("DH_GRADER_PORT", "8000"))
    # http.client rather than urllib: a proxy in the environment must not be asked.
    connection = HTTPConnection(_ANYWHERE.get(host, host), port, timeout=3)
    try:
        connection.request("GET", "/healthz")
        return int(connection.getresponse().status != 200)
    except (OSError, HTTPException):
        return 1
    finally:
        connection.close()


_ANYWHERE = {"0.0.0.0": "127.0.0.1", "::": "::1"}

if __name__ == "__main__":
    raise SystemExit(main())
