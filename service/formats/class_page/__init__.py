"""A class at a glance: a folder with an index of all submissions and a page for each."""

from service.formats.class_page.folder import class_folder

__all__ = ["class_folder"]
