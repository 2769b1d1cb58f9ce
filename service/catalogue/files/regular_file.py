"""Read regular files only."""

import errno
import os
import stat
from pathlib import Path


def read_regular(file: Path, most: int) -> bytes:
    """Return the bytes of a regular file.

    Raises OSError for a pipe, for a device, and for more than ``most`` bytes.
    """
    with open(file, "rb", opener=_open_nonblocking) as opened:
        status = os.fstat(opened.fileno())
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "it is a pipe or device")
        # The file may grow during the read.
        content = b"" if status.st_size > most else opened.read(most + 1)
        if max(status.st_size, len(content)) > most:
            raise OSError(errno.EFBIG, f"it is larger than {most // 1024} KiB")
        return content


def _open_nonblocking(name: str, flags: int) -> int:
    return os.open(name, flags | getattr(os, "O_NONBLOCK", 0))
