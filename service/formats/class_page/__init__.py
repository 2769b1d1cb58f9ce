"""The overview of a class: a folder with an index and a page for each submission."""

from service.formats.class_page.folder import FEEDBACK, class_folder, feedback_zip
from service.formats.class_page.index import INDEX

__all__ = ["FEEDBACK", "INDEX", "class_folder", "feedback_zip"]
