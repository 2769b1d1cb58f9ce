"""The grader for a job of continuous integration, which knows no platform: docs/ci uses it."""

from service.bundles.archive import BundledFile
from service.bundles.content import BundleContent, setup_script, template


def files(content: BundleContent) -> list[BundledFile]:
    """The files of a folder: ``setup.sh`` installs the program in it, ``grade`` runs it."""
    return [
        *content.program(),
        *content.files,
        setup_script(),
        BundledFile("grade", template("ci", "grade"), is_executable=True),
    ]
