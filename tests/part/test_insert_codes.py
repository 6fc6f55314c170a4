"""Insert codes against the tables of ISO 1832 and ANSI B212.4, as makers' catalogues print them."""

from math import radians, tan

import pytest

from core.part.insert_codes import (
    CORNER_ANGLES,
    InsertCodeError,
    decode_insert_code,
    list_metric_circle_sizes,
)
from tests.coded import raises_code

# Code, point angle, inscribed circle, edge, thickness, nose radius, clearance. The edges are the catalogues'
# "l" (or "LE") of each size: 12.9 for CNMG 12, 11.6 for DCMT 11, 16.6 for VNMG 16, 8.7 for WNMG 08 …
CATALOGUE = (
    ("CNMG 120408", 80, 12.7, 12.90, 4.76, 0.8, 0),
    ("CNMG 160616", 80, 15.875, 16.12, 6.35, 1.6, 0),
    ("CCMT 060204", 80, 6.35, 6.45, 2.38, 0.4, 7),
    ("CCMT 09T308", 80, 9.525, 9.67, 3.97, 0.8, 7),
    ("DCMT 11T304", 55, 9.525, 11.63, 3.97, 0.4, 7),
    ("DNMG 150608", 55, 12.7, 15.50, 6.35, 0.8, 0),
    ("DCMT 070202", 55, 6.35, 7.75, 2.38, 0.2, 7),
    ("VNMG 160404", 35, 9.525, 16.61, 4.76, 0.4, 0),
    ("VCGT 110302", 35, 6.35, 11.07, 3.18, 0.2, 7),
    ("TNMG 160408", 60, 9.525, 16.50, 4.76, 0.8, 0),
    ("TCMT 110204", 60, 6.35, 11.00, 2.38, 0.4, 7),
    ("TPMR 220412", 60, 12.7, 22.00, 4.76, 1.2, 11),
    ("SNMG 120412", 90, 12.7, 12.70, 4.76, 1.2, 0),
    ("SCMT 09T304", 90, 9.525, 9.525, 3.97, 0.4, 7),
    ("WNMG 080408", 80, 12.7, 8.69, 4.76, 0.8, 0),
    ("WNMG 060408", 80, 9.525, 6.52, 4.76, 0.8, 0),
)
# The same insert in inches and in millimetres.
PAIRS = (
    ("CNMG432", "CNMG 120408"),
    ("CNMG 431", "CNMG 120404"),
    ("CNMG-543", "CNMG 160612"),
    ("DCMT 32.51", "DCMT 11T304"),
    ("CCMT21.51", "CCMT 060204"),
    ("TNMG 332", "TNMG 160408"),
    ("TPG 322", "TPGN 160308"),
    ("VNMG331", "VNMG 160404"),
    ("WNMG 432", "WNMG 080408"),
    ("SNMG 643", "SNMG 190612"),
    ("TCMT 1.81.51", "TCMT 090204"),
    ("DNMG 442", "DNMG 150608"),
)


@pytest.mark.parametrize(("code", "angle", "circle", "edge", "thick", "nose", "clearance"), CATALOGUE)
def test_metric_code_gives_catalog_dimensions(
    code: str, angle: float, circle: float, edge: float, thick: float, nose: float, clearance: float
) -> None:
    insert = decode_insert_code(code)
    assert insert.point_angle == angle
    assert insert.inscribed_circle == pytest.approx(circle, abs=0.001)
    assert insert.edge_lengths[0] == pytest.approx(edge, abs=0.01)
    assert (insert.thickness, insert.nose_radius, insert.clearance_angle) == (thick, nose, clearance)


@pytest.mark.parametrize(("inch", "metric"), PAIRS)
def test_inch_code_equals_metric_insert(inch: str, metric: str) -> None:
    one, other = decode_insert_code(inch), decode_insert_code(metric)
    assert one.corner_angles == other.corner_angles
    assert one.inscribed_circle == pytest.approx(other.inscribed_circle, abs=0.001)
    assert one.thickness == pytest.approx(other.thickness, abs=0.01)  # 4.76 stands for 3/16 in
    assert one.nose_radius == pytest.approx(other.nose_radius, abs=0.01)  # .8 for 1/32 in


def test_inch_nose_radius_is_in_64ths_of_an_inch() -> None:
    assert decode_insert_code("CNMG432").nose_radius == pytest.approx(25.4 / 32)
    assert decode_insert_code("VCGT 22.50.5").nose_radius == pytest.approx(0.2032)


@pytest.mark.parametrize("code", ["cnmg 12 04 08", "CNMG 120408-PM", "CNMG120408 EN", "CNMG_120408"])
def test_spacing_and_maker_suffix_do_not_change_insert(code: str) -> None:
    assert decode_insert_code(code) == decode_insert_code("CNMG 120408")


def test_round_insert_has_nose_radius_of_half_its_diameter() -> None:
    assert decode_insert_code("RCMT 10T3M0").nose_radius == 5.0
    assert decode_insert_code("RNMG 120400").nose_radius == pytest.approx(6.35)
    assert decode_insert_code("RCMT 1204M0").nose_radius == 6.0, "with M0 the size is metric"
    assert decode_insert_code("RNMG 43").nose_radius == pytest.approx(6.35)
    assert decode_insert_code("RNMG 43").corner_angles == ()


def test_knux_is_the_only_parallelogram() -> None:
    insert = decode_insert_code("KNUX 160405R11")
    assert insert.edge_lengths[1] == 16.15
    assert insert.edge_lengths[0] == pytest.approx(
        9.525 / 0.81915, abs=0.001
    )  # the circle's width over sin 55°


@pytest.mark.parametrize("shape", [shape for shape in CORNER_ANGLES if shape not in "RK"])
def test_metric_size_is_edge_length_in_whole_millimeters(shape: str) -> None:
    """ISO 1832, symbol 5; the standard's tables list 16 for T 3/8 in, 22 for 1/2 in, 08 for W 1/2 in."""
    for figures, circle in list_metric_circle_sizes(shape).items():
        edge = decoded_edge(shape, circle)
        if figures not in {"L3", "03", "04"}:  # makers' and doubled names
            assert int(figures) == int(edge + 0.005)


def decoded_edge(shape: str, circle: float) -> float:
    first, second = CORNER_ANGLES[shape][:2]
    return circle / 2 * (1 / tan(radians(first / 2)) + 1 / tan(radians(second / 2)))


@pytest.mark.parametrize(
    ("insert", "code", "value"),
    [
        ("QNMG432", "unknown-character", "character 1 (Q)"),
        ("LNMG432", "unknown-character", "character 1 (L)"),
        ("CZMG 120408", "unknown-character", "character 2 (Z)"),
        ("CNXG 120408", "unknown-character", "character 3 (X)"),
        ("CNMY 120408", "unknown-character", "character 4 (Y)"),
        ("CNMGX432", "unknown-character", "character 5 (X)"),
        ("CNMG 139408", "unknown-character", "characters 5 and 6 (13)"),
        ("CNMG 121308", "unknown-character", "characters 7 and 8 (13)"),
        ("CNMG 120407", "unknown-character", "characters 9 and 10 (07)"),
        ("CNMG 12040", "character-missing", "10"),
        ("CNMG 1204", "character-missing", "9"),
        ("CNMG932", "unknown-character", "character 5 (9)"),
        ("CNMG492", "unknown-character", "character 6 (9)"),
        ("CNMG439", "unknown-character", "character 7 (9)"),
        ("CNMG43", "character-missing", "7"),
        ("CNMG4321", "unknown-character", "characters 5 and 6 (43)"),
        ("CNM 120408", "character-missing", "4"),
        ("CNMG", "character-missing", "5"),
        ("RCMT 10T304", "unknown-character", "characters 9 and 10 (04)"),
        ("ÄNMG432", "unknown-character", "character 1 (Ä)"),
        ("432", "character-missing", "1"),
        ("", "character-missing", "1"),
    ],
)
def test_invalid_code_names_the_wrong_character(insert: str, code: str, value: str) -> None:
    with raises_code(InsertCodeError, code, value) as caught:
        decode_insert_code(insert)
    assert str(caught.value).startswith(f"{insert}: ")


@pytest.mark.parametrize(
    ("circle", "figures"),
    [  # the keys to insert codes of two catalogues: C, D, S, T, V, W by the inscribed circle
        (4.7625, ("04", "05", "04", "08", "08", "L3")),
        (5.55625, ("05", "06", "05", "09", "09", "03")),
        (6.35, ("06", "07", "06", "11", "11", "04")),
        (7.9375, ("08", "09", "07", "13", "13", "05")),
        (11.1125, ("11", "13", "11", "19", "19", "07")),
        (14.2875, ("14", "17", "14", "24", "24", "09")),
        (17.4625, ("17", "21", "17", "30", "30", "11")),
        (22.225, ("22", "27", "22", "38", "38", "15")),
    ],
)
def test_inscribed_circles_match_catalogs(circle: float, figures: tuple[str, ...]) -> None:
    for shape, name in zip("CDSTVW", figures, strict=True):
        assert list_metric_circle_sizes(shape)[name] == pytest.approx(circle)


def test_thin_small_inserts_have_maker_dimensions() -> None:
    assert decode_insert_code("CCMT 040204").inscribed_circle == pytest.approx(4.7625)
    assert decode_insert_code("CCGT 04T002").inscribed_circle == 4.3
    assert decode_insert_code("CCGT 030102").inscribed_circle == 3.5
    assert decode_insert_code("CCGT 03S102").thickness == 1.39


def test_a_large_triangle_is_not_rounded_up() -> None:
    assert list_metric_circle_sizes("T")["54"] == pytest.approx(31.75)  # 54.993 mm
