"""Upload a platform's zip file of a class, and see the report."""

import csv
import io
import random
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import openpyxl
import pytest
from playwright.sync_api import Page, expect

from tests.browser.fixtures import Visit

RIGHT = "a, alpha, d, theta\na1, 0, 0, theta1\na2, 0, 0, theta2\n"
# As Moodle names them; the last one is larger than any answer.
MOODLE = {
    "Ada Byron_1234_assignsubmission_file/table.csv": RIGHT,
    "Zoë Okri_1235_assignsubmission_file/table.csv": RIGHT.replace("a2, 0", "a2, pi/2"),
    "Max Bomb_1236_assignsubmission_file/table.csv": "0" * 50_000_000,
    "__MACOSX/._table.csv": "x",
}


def saved(page: Page, button: str, folder: Path) -> Path:
    with page.expect_download() as downloading:
        page.get_by_role("button", name=button).click()
    file = folder / downloading.value.suggested_filename
    downloading.value.save_as(file)
    return file


def upload(page: Page, service: str, chosen: Path) -> None:
    page.goto(f"{service}/tutor/class")
    page.get_by_label("Exercise").select_option("planar-rr")
    expect(page.get_by_label("Part").locator("option")).not_to_have_count(1)
    page.get_by_label("Part").select_option("table")
    page.get_by_label("Zip file").set_input_files(chosen)


@pytest.mark.long
def test_a_platforms_zip_file_gives_gradebook_and_feedback_pages(
    visit: Callable[..., Visit], service: str, tmp_path: Path
) -> None:
    chosen = tmp_path / "submissions.zip"
    with zipfile.ZipFile(chosen, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in MOODLE.items():
            archive.writestr(name, text)
    page = visit().page
    upload(page, service, chosen)
    state = page.get_by_role("status")
    expect(state).to_have_text("3 submissions. The service does not keep them.")
    with saved(page, "Gradebook", tmp_path).open(encoding="utf-8") as book:
        grades = {line["Identifier"]: line["Grade"] for line in csv.DictReader(book)}
    assert grades.keys() == {"Participant 1234", "Participant 1235", "Participant 1236"}
    assert float(grades["Participant 1234"]) > float(grades["Participant 1235"]) > 0
    assert grades["Participant 1236"] == ""
    with zipfile.ZipFile(saved(page, "Feedback pages", tmp_path)) as pages:
        assert pages.testzip() is None
        texts = {name: pages.read(name).decode() for name in pages.namelist()}
    assert sorted(texts) == [f"reports/Participant-{number}.html" for number in (1234, 1235, 1236)]
    assert not re.search("Ada|Byron|Okri|Bomb|assignsubmission|/tmp", "".join(texts.values()))
    assert "table.csv for planar-rr" in texts["reports/Participant-1234.html"]

    broken = tmp_path / "broken.zip"
    broken.write_bytes(chosen.read_bytes()[:-100])
    page.get_by_label("Zip file").set_input_files(broken)
    expect(state).to_have_text("The zip file is damaged. Download it again.")


def workbook(rows: list[str], dice: random.Random) -> bytes:
    """Return a workbook with a picture: 12 kB that no compression makes smaller."""
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append([cell.strip() for cell in row.split(",")])
    packed = io.BytesIO()
    book.save(packed)
    with zipfile.ZipFile(packed, "a") as archive:
        archive.writestr("xl/media/image1.png", dice.randbytes(12_000))
    return packed.getvalue()


@pytest.mark.long
def test_a_class_of_120_workbooks_with_pictures_is_graded(
    visit: Callable[..., Visit], service: str, tmp_path: Path
) -> None:
    dice = random.Random(5)
    chosen = tmp_path / "submissions.zip"
    with zipfile.ZipFile(chosen, "w", zipfile.ZIP_DEFLATED) as archive:
        for number in range(120):
            name = f"Student {number}_{1000 + number}_assignsubmission_file/table.xlsx"
            archive.writestr(name, workbook(RIGHT.splitlines(), dice))
    page = visit().page
    upload(page, service, chosen)
    state = page.get_by_role("status")
    expect(state).to_have_text("120 submissions. The service does not keep them.", timeout=60_000)
    with saved(page, "Gradebook", tmp_path).open(encoding="utf-8") as book:
        grades = [line["Grade"] for line in csv.DictReader(book)]
    assert len(grades) == 120
    assert len(set(grades)) == 1
    assert float(grades[0]) > 0


SHEET = (
    "Identifier,Full name,Status,Grade,Maximum grade,Grade can be changed,"
    "Last modified (submission),Last modified (grade),Feedback comments\r\n"
    "Participant 1234,Ada Byron,Submitted,,4.00,Yes,-,-,\r\n"
    "Participant 1235,Zoë Okri,Submitted,,4.00,Yes,-,-,\r\n"
)


@pytest.mark.long
def test_the_worksheet_is_filled_and_a_download_in_a_zip_file_is_found(
    visit: Callable[..., Visit], service: str, tmp_path: Path
) -> None:
    inner = io.BytesIO()
    with zipfile.ZipFile(inner, "w") as archive:
        for name in list(MOODLE)[:2]:
            archive.writestr(name, MOODLE[name])
        photo = random.Random(1).randbytes(400_000)
        archive.writestr("Ada Byron_1234_assignsubmission_file/photo.png", photo)
        archive.writestr("../Ben Out_1236_assignsubmission_file/x.csv", RIGHT)
    chosen = tmp_path / "again.zip"
    with zipfile.ZipFile(chosen, "w") as archive:
        archive.writestr("HW3-4711.zip", inner.getvalue())
    sheet = tmp_path / "Grades 3.csv"
    sheet.write_bytes(SHEET.encode())
    page = visit().page
    upload(page, service, chosen)
    state = page.get_by_role("status")
    expect(state).to_have_text("3 submissions. The service does not keep them.")
    expect(
        page.frame_locator("#report").get_by_text("Ben Out (Participant 1236)").first
    ).to_be_visible()
    expect(page.get_by_role("button", name="Filled worksheet")).to_be_hidden()
    # The worksheet may be chosen after the zip file.
    page.get_by_label("Worksheet, if you have one").set_input_files(sheet)
    told = page.get_by_role("list", name="Worksheet").get_by_role("listitem")
    expect(told.first).to_have_text(
        "Grades filled in: 2. Already the same: 0. Left for grading by hand: 1."
    )
    expect(told).to_have_count(3)
    expect(told.nth(1)).to_contain_text("Ben Out_1236_assignsubmission_file/x.csv is in no row")
    expect(told.nth(2)).to_contain_text("file that was not read, such as a photo")
    filled = saved(page, "Filled worksheet", tmp_path)
    assert filled.name == "Grades 3-graded.csv"
    with filled.open(encoding="utf-8", newline="") as opened:
        grades = {row["Identifier"]: row["Grade"] for row in csv.DictReader(opened)}
    assert grades["Participant 1234"] == "4"
    assert 0 < float(grades["Participant 1235"]) < 4
