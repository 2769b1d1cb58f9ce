"""The folder of a class: a page for each submission, then the index."""

from collections.abc import Callable, Iterable, Iterator
from typing import Final

from service.formats.class_page.file_names import distinct_file_names
from service.formats.class_page.index import INDEX, index
from service.formats.class_page.overview import Overview
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.report_format import Document, Setting

# The subfolder of the pages.
PAGES: Final = "reports"

Pages = Callable[[Iterable[GradedSubmission], Setting], Iterator[bytes]]
Folder = Callable[[Iterable[GradedSubmission], Setting], Iterator[Document]]


def class_folder(page: Pages) -> Folder:
    """Return a function that yields the files of a class's folder.

    ``page`` writes the page of one submission.
    """

    def documents(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[Document]:
        overview = Overview({each.id: each for each in setting.exercises})
        file_name = distinct_file_names(".html")
        for submission in submissions:
            path = f"{PAGES}/{file_name(submission.learner)}"
            overview.add(submission, path)
            yield Document(path, page([submission], setting))
        yield Document(INDEX, index(overview, setting.language))

    return documents
