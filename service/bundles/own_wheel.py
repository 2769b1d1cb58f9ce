"""Build a wheel of the running program from its installed files.

So a bundle contains exactly this version, whether installed from a wheel or a checkout. Source:
https://packaging.python.org/en/latest/specifications/binary-distribution-format/.
"""

import base64
import csv
import hashlib
import io
from collections.abc import Iterator
from importlib.metadata import Distribution, distribution
from pathlib import Path

from service.bundles.archive import BundledFile, zipped
from service.catalogue import shipped_folder
from service.translations.catalogues import compiled_catalogue

_NAME = "dh-grader"
_WHEEL = "Wheel-Version: 1.0\nGenerator: dh-grader\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
_PACKAGE = Path(__file__).parents[1]


def own_wheel() -> BundledFile:
    """Return a wheel of the running program, with the file name that installers expect."""
    installed = distribution(_NAME)
    stem = f"{_NAME.replace('-', '_')}-{installed.version}"
    files = [*_program(), *_metadata(installed, f"{stem}.dist-info")]
    record = f"{stem}.dist-info/RECORD"
    files.append(BundledFile(record, _record(files, record)))
    return BundledFile(f"{stem}-py3-none-any.whl", zipped(files))


def locked_requirements() -> BundledFile:
    """Return the file of pinned dependencies with hashes."""
    packaged = _PACKAGE / "_requirements.lock"
    lock = packaged if packaged.is_file() else _PACKAGE.parent / "requirements.lock"
    return BundledFile("requirements.lock", lock.read_bytes())


def _program() -> Iterator[BundledFile]:
    yield from _below(_PACKAGE, "service")
    if not (_PACKAGE / "_exercises").is_dir():
        yield from _below(shipped_folder(), "service/_exercises")
        yield BundledFile("service/_requirements.lock", locked_requirements().content)


def _below(folder: Path, name: str) -> Iterator[BundledFile]:
    for file in sorted(folder.rglob("*")):
        if not file.is_file() or "__pycache__" in file.parts:
            continue
        place, content = f"{name}/{file.relative_to(folder).as_posix()}", file.read_bytes()
        # A wheel has the compiled catalogues of translations, a checkout has their texts.
        if file.suffix == ".po":
            yield BundledFile(
                place.removesuffix(".po") + ".mo", compiled_catalogue(content, file.name)
            )
        elif file.suffix != ".mo" or not file.with_suffix(".po").is_file():
            yield BundledFile(place, content)


def _metadata(installed: Distribution, folder: str) -> Iterator[BundledFile]:
    yield BundledFile(f"{folder}/WHEEL", _WHEEL.encode())
    for name in ("METADATA", "entry_points.txt", "licenses/LICENSE", "licenses/NOTICE"):
        text = installed.read_text(name)
        if text is not None:
            yield BundledFile(f"{folder}/{name}", text.encode())


def _record(files: list[BundledFile], record: str) -> bytes:
    written = io.StringIO()
    rows = csv.writer(written, lineterminator="\n")
    for file in files:
        digest = base64.urlsafe_b64encode(hashlib.sha256(file.content).digest()).rstrip(b"=")
        rows.writerow([file.name, f"sha256={digest.decode()}", len(file.content)])
    rows.writerow([record, "", ""])
    return written.getvalue().encode()
