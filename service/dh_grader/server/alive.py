"""`python -m dh_grader.server.alive`: the health check of the container image.

It imports nothing else of the program, so the check is cheap to run.
"""

import os
from http.client import HTTPConnection, HTTPException

_ANYWHERE = {"0.0.0.0": "127.0.0.1", "::": "::1"}


def main() -> int:
    """Request /healthz at DH_GRADER_HOST and DH_GRADER_PORT; return the exit code."""
    host = os.environ.get("DH_GRADER_HOST", "127.0.0.1")
    port = int(os.environ.get("DH_GRADER_PORT", "8000"))
    # http.client rather than urllib, which would use a proxy that the environment names.
    connection = HTTPConnection(_ANYWHERE.get(host, host), port, timeout=3)
    try:
        connection.request("GET", "/healthz")
        return int(connection.getresponse().status != 200)
    except (OSError, HTTPException):
        return 1
    finally:
        connection.close()


if __name__ == "__main__":
    raise SystemExit(main())
