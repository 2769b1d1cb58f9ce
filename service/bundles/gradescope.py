"""The bundle for Gradescope: ``setup.sh`` builds the image, ``run_autograder`` grades.

Source: https://gradescope-autograders.readthedocs.io/en/latest/specs/, "File hierarchy".
"""

from service.bundles.archive import BundledFile
from service.bundles.content import BundleContent, setup_script, template


def files(content: BundleContent) -> list[BundledFile]:
    """Return the files of the bundle for Gradescope."""
    script = template("gradescope", "run_autograder")
    return [
        *content.program(),
        *content.files,
        *([] if content.variants is None else [content.variants.file()]),
        setup_script(),
        BundledFile("run_autograder", script, is_executable=True),
    ]
