from pathlib import Path

import pytest
from dh_grader.web.pages import load_assets


def test_a_name_changes_with_the_file_and_with_the_files_it_names(tmp_path: Path) -> None:
    for room in ("page", "shared"):
        (tmp_path / room).mkdir()
    entry, dom = tmp_path / "page" / "entry.js", tmp_path / "shared" / "dom.js"
    entry.write_text('import { h } from "../shared/dom.js";\n', encoding="utf-8")
    dom.write_text("export const h = 1;\n", encoding="utf-8")
    before = load_assets(tmp_path)
    dom.write_text("export const h = 2;\n", encoding="utf-8")
    after = load_assets(tmp_path)
    for name in ("entry.js", "dom.js"):
        assert before.name(name) != after.name(name)
    assert f'"./{after.name("dom.js")}"'.encode() in after.by_plain_name["entry.js"].content
    assert after.modules("entry.js") == [after.name("entry.js"), after.name("dom.js")]


def test_a_file_that_names_an_absent_one_is_refused(tmp_path: Path) -> None:
    (tmp_path / "entry.js").write_text('import "./gone.js";\n', encoding="utf-8")
    with pytest.raises(LookupError, match=r"gone\.js"):
        load_assets(tmp_path)


def test_a_path_to_the_wrong_room_is_refused(tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared" / "dom.js").write_text("", encoding="utf-8")
    (tmp_path / "entry.js").write_text('import "./dom.js";\n', encoding="utf-8")
    with pytest.raises(LookupError, match=r"dom\.js"):
        load_assets(tmp_path)


def test_two_files_of_one_name_are_refused(tmp_path: Path) -> None:
    for room in ("student", "tutor"):
        (tmp_path / room).mkdir()
        (tmp_path / room / "cell.js").write_text("", encoding="utf-8")
    with pytest.raises(ValueError, match=r"cell\.js"):
        load_assets(tmp_path)


def test_an_address_of_the_service_is_not_taken_for_a_file(tmp_path: Path) -> None:
    text = 'post("../tutor/check"); new URL("../", import.meta.url);\n'
    (tmp_path / "entry.js").write_text(text, encoding="utf-8")
    assert load_assets(tmp_path).by_plain_name["entry.js"].content == text.encode()


def test_a_page_does_not_preload_what_a_script_loads_later(tmp_path: Path) -> None:
    text = 'later(import.meta.resolve("./scene.js"), () => import("./scene.js"));\n'
    (tmp_path / "entry.js").write_text(text, encoding="utf-8")
    (tmp_path / "scene.js").write_text("", encoding="utf-8")
    assets = load_assets(tmp_path)
    assert assets.modules("entry.js") == [assets.name("entry.js")]
    content = assets.by_plain_name["entry.js"].content.decode()
    assert content.count(f'"./{assets.name("scene.js")}"') == 2
