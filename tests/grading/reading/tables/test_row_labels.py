"""The spellings of row labels: 1, Link 2, 0→1, e, TCP."""

from service.grading.reading.tables.row_labels import LAST, label_place
from tests.together import together


@together(
    ("text", "place"),
    [
        ("1", 1), ("12", 12), ("1.", 1), ("Link 1", 1), ("link1", 1), ("J3", 3), ("joint 3", 3),
        ("{2}", 2), ("$2$", 2), ("A_2", 2), ("L_{2}", 2), ("0→1", 1), ("2 - 3", 3), ("0 -> 1", 1),
        ("1 to 2", 2), ("①", 1),
        ("e", LAST), ("E", LAST), ("ee", LAST), ("tool", LAST), ("TCP", LAST),
        ("End effector", LAST), ("end-effector", LAST), ("n+1", LAST), ("$e$", LAST),
        ("", None), ("arm", None), ("1→3", None), ("q1", None), ("-1", None), ("1" * 40, None),
        ("100", None), ("pi", None), ("0.5", None), ("\ud800", None),
    ],
)  # fmt: skip
def test_row_labels(text: str, place: int | None) -> None:
    assert label_place(text) == place
