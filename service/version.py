"""The program's version, as it is installed."""

from importlib.metadata import version
from typing import Final

VERSION: Final = version("dh-grader")
