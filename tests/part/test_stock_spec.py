"""What a user says about the stock, and what is refused."""

from __future__ import annotations

import pytest

from core.part.stock_spec import StockError, parse_stock_profile, parse_stock_specification
from tests.coded import raises_code


def test_bar_without_length_is_as_long_as_program_needs() -> None:
    stock = parse_stock_specification("bar:1.0+.02").stock(back_z_mm=-25.4, unit_mm=25.4)
    assert stock.specification_text == "bar:1.0+.02"
    assert stock.max_radius_mm == pytest.approx(12.7)
    assert stock.front_z_mm == pytest.approx(0.508)
    assert stock.back_z_mm < -25.4


def test_stock_length_is_measured_from_face() -> None:
    stock = parse_stock_specification("bar:25mm:60mm+1mm").stock(back_z_mm=-500.0, unit_mm=25.4)
    assert (stock.back_z_mm, stock.front_z_mm, stock.max_radius_mm) == (
        pytest.approx(-59.0),
        pytest.approx(1.0),
        pytest.approx(12.5),
    )


def test_a_tube_has_its_bore() -> None:
    stock = parse_stock_specification("tube:1.5:.75:2").stock(back_z_mm=0.0, unit_mm=25.4)
    assert stock.bore_profile[0] == (pytest.approx(-50.8), pytest.approx(9.525))
    assert stock.outside_profile[0] == (pytest.approx(-50.8), pytest.approx(19.05))


def test_file_stock_is_parsed_with_allowance_and_plus_in_name() -> None:
    assert parse_stock_specification("after:op 10+.5.nc").after == "op 10+.5.nc"
    spec = parse_stock_specification("after:op10.nc+.02")
    assert (spec.after, spec.allowance) == ("op10.nc", pytest.approx(0.508))
    assert parse_stock_specification("profile:casting.csv").profile == "casting.csv"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "unknown-form"),
        ("rod:1", "unknown-form"),
        ("bar:", "not-a-length"),
        ("bar:one", "not-a-length"),
        ("bar:-1", "not-a-length"),
        ("bar:0", "diameter"),
        ("bar:40", "diameter"),  # 1016 mm
        ("bar:1:0", "length"),
        ("bar:1:2:3", "size-count"),
        ("tube:1", "size-count"),
        ("tube:1:1", "bore"),
        ("tube:1:2", "bore"),
        ("bar:1+", "not-a-length"),
        ("bar:1+x", "not-a-length"),
        ("after:", "no-file"),
        ("profile:", "no-file"),
    ],
)
def test_invalid_stock_is_rejected(text: str, code: str) -> None:
    with raises_code(StockError, code, text):
        parse_stock_specification(text)


def test_profile_is_read_in_either_order_with_or_without_header() -> None:
    rising = parse_stock_profile("p", "z,r\n-2,1\n-1,1\n-1,.5\n0,.5\n", 25.4, 0.0)
    falling = parse_stock_profile("p", "0,.5\n-1,.5\n-1,1\n-2,1\n", 25.4, 0.0)
    assert rising.outside_profile == falling.outside_profile
    assert rising.outside_profile[0] == (pytest.approx(-50.8), pytest.approx(25.4))
    tubular = parse_stock_profile("p", "-10,6,2\n0,6,3\n", 1.0, 0.5)
    assert tubular.bore_profile == ((-9.5, 2.0), (0.5, 3.0))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "too-few-points"),
        ("0,1\n", "too-few-points"),
        ("0,1\n-1,x\n", "not-numbers"),
        ("0,1\n-1,nan\n", "not-numbers"),
        ("0,1\n-inf,1\n", "not-numbers"),
        ("0,1\n-1e9,1\n", "too-far-out"),
        ("0,1\r-1,1\r", "damaged"),
        (f"0,1\n-1,{'1' * 200_000}\n", "damaged"),
        ("0,1\n-1\n", "number-count"),
        ("0,1\n-1,1,.5\n", "rows-differ"),
        ("0,1\n-2,1\n-1,1\n", "turns-back"),
        ("0,1\n-1,-1\n", "radius"),
        ("0,1,2\n-1,1,.5\n", "radius"),
    ],
)
def test_invalid_profile_is_rejected(text: str, code: str) -> None:
    with raises_code(StockError, code):
        parse_stock_profile("p", text, 25.4, 0.0)
