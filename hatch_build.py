"""Compile the catalogues of translations into the wheel, which leaves out their texts."""

import runpy
import shutil
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CompiledCatalogues(BuildHookInterface[Any]):
    """Adds a ``.mo`` file for each ``.po`` file; Git and a checkout have only the texts."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile the catalogues into a temporary folder, unless the install reads the checkout."""
        if version == "editable":
            return
        translations = Path(self.root, "service", "dh_grader", "translations")
        # The build environment has no package that the program needs.
        compiled = runpy.run_path(str(translations / "__init__.py"))["compiled_catalogue"]
        self._folder = tempfile.mkdtemp()
        for text in sorted(translations.glob("*/*.po")):
            name = f"{text.parent.name}/{text.stem}.mo"
            made = Path(self._folder, name)
            made.parent.mkdir(exist_ok=True)
            made.write_bytes(compiled(text.read_bytes(), text.name))
            build_data["force_include"][str(made)] = f"dh_grader/translations/{name}"

    def finalize(self, version: str, *_: object) -> None:
        """Remove the temporary folder."""
        if version != "editable":
            shutil.rmtree(self._folder)
