"""The bundle for jobs of continuous integration on any platform; see docs/ci."""

from service.bundles.archive import BundledFile
from service.bundles.content import BundleContent, BundleError, setup_script, template


def files(content: BundleContent) -> list[BundledFile]:
    """Return the files of the bundle for continuous integration. Raises BundleError."""
    if content.variants is not None:
        reason = "a job does not know whose files it grades, so this bundle cannot have variants"
        raise BundleError(f"{reason}; leave out variants in the assignment")
    return [
        *content.program(),
        *content.files,
        setup_script(),
        BundledFile("grade", template("ci", "grade"), is_executable=True),
    ]
