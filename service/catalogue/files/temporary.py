"""Choose the place for temporary folders that several processes share."""

import os
import tempfile
from pathlib import Path
from typing import Final

# A folder in memory, which is writable even in a container with a read-only file system.
_MEMORY: Final = Path("/dev/shm")


def temporary_place() -> Path:
    """Return a folder for temporary files, in memory if possible."""
    if os.access(_MEMORY, os.W_OK):
        return _MEMORY
    try:
        return Path(tempfile.gettempdir())
    except OSError:
        return Path.cwd()
