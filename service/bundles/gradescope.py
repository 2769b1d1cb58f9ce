"""The autograder of Gradescope: ``setup.sh`` builds its image, ``run_autograder`` grades.

Source: https://gradescope-autograders.readthedocs.io/en/latest/specs/, "File hierarchy".
"""

from service.bundles.archive import BundledFile
from service.bundles.content import BundleContent, setup_script, template


def files(content: BundleContent) -> list[BundledFile]:
    """The files of the zip that is uploaded, the two scripts at its top."""
    script = template("gradescope", "run_autograder")
    return [
        *content.program(),
        *content.files,
        setup_script(),
        BundledFile("run_autograder", script, is_executable=True),
    ]
