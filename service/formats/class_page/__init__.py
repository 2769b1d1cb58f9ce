"""The overview of a class: a folder with an index and a page for each submission."""

from service.formats.class_page.folder import class_folder, feedback_zip

__all__ = ["class_folder", "feedback_zip"]
