"""`python -m tests.server.impatient`: the service with little patience, so that tests need none."""

from service.cli import main
from service.server import crowd, process, protocol

PATIENCE = 1.0

if __name__ == "__main__":
    for module, name, seconds in (
        (protocol, "PATIENCE", PATIENCE),
        (protocol, "LINGER", 0.3),
        (crowd, "SWEEP", 0.05),
        (process, "GRACE", PATIENCE / 2),
    ):
        vars(module)[name] = seconds
    main()
