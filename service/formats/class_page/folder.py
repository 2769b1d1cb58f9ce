"""The folder of a class: a page for each submission, then the index."""

import io
import zipfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import PurePath
from typing import Final

from service.formats.class_page.file_names import distinct_file_names
from service.formats.class_page.index import INDEX, index
from service.formats.class_page.overview import Overview
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.report_format import Document, Setting
from service.regex import regex

# The subfolder of the pages.
PAGES: Final = "reports"
# The name of the page of each student in the zip file for Moodle.
FEEDBACK: Final = "feedback.html"

# The student and the number in the names that Moodle gives.
_MOODLE: Final = regex(r"(?P<name>.+?)_(?P<number>\d+)(?:_assignsubmission_.*)?")

Pages = Callable[[Iterable[GradedSubmission], Setting], Iterator[bytes]]
Folder = Callable[[Iterable[GradedSubmission], Setting], Iterator[Document]]


def class_folder(page: Pages) -> Folder:
    """Return a function that yields the files of a class's folder.

    ``page`` writes the page of one submission.
    """

    def documents(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[Document]:
        overview = Overview(
            {each.id: each for each in setting.exercises},
            folder=setting.folder,
            left_out=setting.left_out,
        )
        file_name = distinct_file_names(".html")
        for submission in submissions:
            path = f"{PAGES}/{file_name(submission.learner)}"
            overview.add(submission, path)
            yield Document(path, page([submission], setting))
        yield Document(INDEX, index(overview, setting.language))

    return documents


def feedback_zip(
    submissions: Iterable[GradedSubmission], setting: Setting, page: Pages
) -> Iterator[bytes]:
    """Yield a zip file with the page of each submission, as Moodle takes feedback files.

    Moodle (``mod/assign/feedback/file/importziplib.php``) divides the name of a folder at ``_``;
    the second piece is the number of the student.
    """
    file_name = distinct_file_names("")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for submission in submissions:
            folder = file_name(submission.learner)
            found = _MOODLE.fullmatch(PurePath(submission.name).name)
            if found and submission.learner.endswith(f" {found['number']}"):
                name = found["name"].replace("_", " ")
                folder = f"{name}_{found['number']}_assignsubmission_file_"
            archive.writestr(f"{folder}/{FEEDBACK}", b"".join(page([submission], setting)))
    yield packed.getvalue()
