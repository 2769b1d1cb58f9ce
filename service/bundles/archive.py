"""Pack files into a reproducible zip file."""

import io
import stat
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass

# The earliest time that a zip file can represent.
_NO_TIME = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True, slots=True)
class BundledFile:
    """A file of a bundle; ``name`` is its path in the bundle, with ``/``."""

    name: str
    content: bytes
    is_executable: bool = False


def zipped(files: Iterable[BundledFile]) -> bytes:
    """Return a zip file of the files; equal files give equal bytes."""
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(files, key=lambda file: file.name):
            entry = zipfile.ZipInfo(file.name, _NO_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, so that the modes below are used
            entry.external_attr = (stat.S_IFREG | (0o755 if file.is_executable else 0o644)) << 16
            archive.writestr(entry, file.content)
    return written.getvalue()
