"""The bundle for jobs of continuous integration on any platform; see docs/ci."""

from service.bundles.archive import BundledFile
from service.bundles.content import BundleContent, setup_script, template


def files(content: BundleContent) -> list[BundledFile]:
    """Return the files of a folder: ``setup.sh`` installs the grader in it, ``grade`` runs it."""
    return [
        *content.program(),
        *content.files,
        setup_script(),
        BundledFile("grade", template("ci", "grade"), is_executable=True),
    ]
