"""What a user says about the stock, and what is refused."""

from __future__ import annotations

import pytest

from core.part.stock_spec import StockError, profile_stock, stock_spec
from tests.coded import raises_code


def test_a_bar_is_as_long_as_the_program_needs() -> None:
    stock = stock_spec("bar:1.0+.02").stock(back=-25.4, unit=25.4)
    assert stock.given == "bar:1.0+.02"
    assert stock.radius == pytest.approx(12.7)
    assert stock.front == pytest.approx(0.508)
    assert stock.back < -25.4


def test_a_length_counts_from_the_face() -> None:
    stock = stock_spec("bar:25mm:60mm+1mm").stock(back=-500.0, unit=25.4)
    assert (stock.back, stock.front, stock.radius) == (
        pytest.approx(-59.0),
        pytest.approx(1.0),
        pytest.approx(12.5),
    )


def test_a_tube_has_its_bore() -> None:
    stock = stock_spec("tube:1.5:.75:2").stock(back=0.0, unit=25.4)
    assert stock.bore[0] == (pytest.approx(-50.8), pytest.approx(9.525))
    assert stock.outside[0] == (pytest.approx(-50.8), pytest.approx(19.05))


def test_files_are_named_with_an_allowance_or_with_a_plus_in_the_name() -> None:
    assert stock_spec("after:op 10+.5.nc").after == "op 10+.5.nc"
    spec = stock_spec("after:op10.nc+.02")
    assert (spec.after, spec.allowance) == ("op10.nc", pytest.approx(0.508))
    assert stock_spec("profile:casting.csv").profile == "casting.csv"


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
def test_what_is_no_stock_is_refused(text: str, code: str) -> None:
    with raises_code(StockError, code, text):
        stock_spec(text)


def test_a_profile_is_read_either_way_with_and_without_a_head() -> None:
    rising = profile_stock("p", "z,r\n-2,1\n-1,1\n-1,.5\n0,.5\n", 25.4, 0.0)
    falling = profile_stock("p", "0,.5\n-1,.5\n-1,1\n-2,1\n", 25.4, 0.0)
    assert rising.outside == falling.outside
    assert rising.outside[0] == (pytest.approx(-50.8), pytest.approx(25.4))
    tubular = profile_stock("p", "-10,6,2\n0,6,3\n", 1.0, 0.5)
    assert tubular.bore == ((-9.5, 2.0), (0.5, 3.0))


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
def test_a_profile_that_is_none_is_refused(text: str, code: str) -> None:
    with raises_code(StockError, code):
        profile_stock("p", text, 25.4, 0.0)
