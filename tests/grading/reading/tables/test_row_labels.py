"""Read row labels such as 1, Link 2, 0→1 or TCP."""

from dh_grader.grading.reading.headers import LAST, label_place

from tests.together import together


@together(
    ("text", "place"),
    [
        ("1", 1), ("12", 12), ("1.", 1), ("Link 1", 1), ("link1", 1), ("J3", 3), ("joint 3", 3),
        ("{2}", 2), ("$2$", 2), ("A_2", 2), ("L_{2}", 2), ("0→1", 1), ("2 - 3", 3), ("0 -> 1", 1),
        ("1 to 2", 2), ("①", 1),
        ("e", LAST), ("E", LAST), ("ee", LAST), ("tool", LAST), ("TCP", LAST),
        ("End effector", LAST), ("end-effector", LAST), ("n+1", LAST), ("$e$", LAST),
        ("Glied 1", 1), ("Gelenk 2", 2), ("Zeile 3", 3), ("Reihe 1", 1), ("Glied-Nr. 2", 2),
        ("Gelenk Nr 3", 3), ("1. Gelenk", 1), ("Körper 2", 2), ("Nr. 4", 4),
        ("Articulation 1", 1), ("Articulation n° 2", 2), ("Segment 3", 3), ("Liaison 1", 1),
        ("Corps 2", 2), ("Axe 3", 3), ("Articulación 1", 1), ("articulacio\u0301n 2", 2),
        ("Eslabón 3", 3), ("Fila 1", 1), ("连杆 1", 1), ("连杆2", 2), ("关节三", 3), ("第2关节", 2),
        ("行 1", 1), ("连杆１", 1),
        ("Endeffektor", LAST), ("effecteur", LAST), ("efector final", LAST), ("末端执行器", LAST),
        ("", None), ("arm", None), ("1→3", None), ("q1", None), ("-1", None), ("1" * 40, None),
        ("100", None), ("pi", None), ("0.5", None), ("\ud800", None),
        ("Glied", None), ("连杆 i", None), ("Gelenkwinkel 1", None), ("长度 1", None),
        ("Nr. 0.5", None),
    ],
)  # fmt: skip
def test_row_labels(text: str, place: int | None) -> None:
    assert label_place(text) == place
