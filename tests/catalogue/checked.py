"""Write the digests of the exercise files that the tests check to ``exercises/checked.json``.

``python -m tests.catalogue.checked`` prints the digests. ``make pages`` runs it.
"""

import json
import sys

from dh_grader.catalogue import exercise_files, load_catalogue, shipped_folder
from dh_grader.catalogue.load import digest_of


def digests() -> dict[str, str]:
    """Return the digest of each shipped file. Raises CatalogueError if one is not valid."""
    folder = shipped_folder()
    load_catalogue(folder)
    return {file.stem: digest_of(file.read_bytes()) for file in exercise_files(folder)}


if __name__ == "__main__":
    sys.stdout.write(json.dumps(digests(), indent=0) + "\n")
