"""The bytes of a file that somebody names; of a regular one only."""

import errno
import os
import stat
from pathlib import Path


def read_regular(file: Path, most: int) -> bytes:
    """The bytes of a regular file; of no other, for a pipe or device may never end, or begin.

    Raises OSError, with ``EFBIG`` where there are more than ``most`` bytes.
    """
    with open(file, "rb", opener=_unblocked) as opened:
        status = os.fstat(opened.fileno())
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "it is a pipe or device")
        # A file may grow while it is read.
        content = b"" if status.st_size > most else opened.read(most + 1)
        if max(status.st_size, len(content)) > most:
            raise OSError(errno.EFBIG, f"it is larger than {most // 1024} KiB")
        return content


def _unblocked(name: str, flags: int) -> int:
    return os.open(name, flags | getattr(os, "O_NONBLOCK", 0))
