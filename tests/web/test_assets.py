from pathlib import Path

import pytest

from service.web.assets import load_assets


def test_a_name_changes_with_its_file_and_with_those_that_the_file_names(tmp_path: Path) -> None:
    (tmp_path / "entry.js").write_text('import { h } from "./dom.js";\n', encoding="utf-8")
    (tmp_path / "dom.js").write_text("export const h = 1;\n", encoding="utf-8")
    before = load_assets(tmp_path)
    (tmp_path / "dom.js").write_text("export const h = 2;\n", encoding="utf-8")
    after = load_assets(tmp_path)
    for name in ("entry.js", "dom.js"):
        assert before.name(name) != after.name(name)
    assert f'"./{after.name("dom.js")}"'.encode() in after.by_plain_name["entry.js"].content
    assert after.modules("entry.js") == [after.name("entry.js"), after.name("dom.js")]


def test_a_file_that_names_an_absent_one_is_refused(tmp_path: Path) -> None:
    (tmp_path / "entry.js").write_text('import "./gone.js";\n', encoding="utf-8")
    with pytest.raises(LookupError, match=r"gone\.js"):
        load_assets(tmp_path)
