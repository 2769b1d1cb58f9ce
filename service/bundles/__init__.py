"""Bundles for grading platforms: zip files with the program, an assignment and scripts."""

from collections.abc import Callable, Mapping
from typing import Final

from service.bundles import ci, gradescope, prairielearn
from service.bundles.archive import BundledFile, zipped
from service.bundles.content import BundleContent, BundleError, content_of

__all__ = ["BUNDLES", "BundleContent", "BundleError", "BundledFile", "content_of", "zipped"]

BUNDLES: Final[Mapping[str, Callable[[BundleContent], list[BundledFile]]]] = {
    "gradescope": gradescope.files,
    "prairielearn": prairielearn.files,
    "ci": ci.files,
}
