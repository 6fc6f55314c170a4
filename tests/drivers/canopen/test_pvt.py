"""PVT records against hand-made bytes and paths whose deviation can be worked out."""

from __future__ import annotations

import math

import pytest

from drivers.canopen.drive_set import pack_epos2_record, unpack_epos2_record
from drivers.canopen.pvt_mode import find_max_deviation, fit_longest_piece, interpolate_hermite

Point = tuple[tuple[float, ...], tuple[float, ...]]


def test_pvt_record_is_packed_into_its_bytes() -> None:
    # position 1000 = 0x000003E8, velocity -2 = 0xFFFFFE, 20 ms = 0x14
    assert pack_epos2_record(20, -2.0, 1000.0) == bytes([0xE8, 0x03, 0, 0, 0xFE, 0xFF, 0xFF, 0x14])
    assert unpack_epos2_record(bytes([0xE8, 0x03, 0, 0, 0xFE, 0xFF, 0xFF, 0x14])) == (20, -2, 1000)
    # position -1, velocity 100000 = 0x0186A0, the end
    assert pack_epos2_record(0, 1e5, -1.0) == bytes([0xFF, 0xFF, 0xFF, 0xFF, 0xA0, 0x86, 0x01, 0])


@pytest.mark.parametrize(
    ("ms", "velocity", "position"),
    [
        (256, 0.0, 0.0),
        (-1, 0.0, 0.0),
        (20, 2.0**23, 0.0),
        (20, -(2.0**23), 0.0),
        (20, math.inf, 0.0),
        (20, 0.0, 2.0**31),
        (20, 0.0, -(2.0**31)),
        (20, 0.0, -math.inf),
        (20, 0.0, math.nan),
    ],
)
def test_value_that_does_not_fit_a_pvt_record_is_rejected(ms: int, velocity: float, position: float) -> None:
    with pytest.raises(ValueError, match=f"{ms} ms"):
        pack_epos2_record(ms, velocity, position)


def test_largest_position_of_a_pvt_record_is_packed() -> None:
    # 2³¹ - 1 = 0x7FFFFFFF; its negative is 0x80000001
    assert pack_epos2_record(1, 0.0, 2.0**31 - 1) == bytes([0xFF, 0xFF, 0xFF, 0x7F, 0, 0, 0, 1])
    assert pack_epos2_record(1, 0.0, 1 - 2.0**31) == bytes([1, 0, 0, 0x80, 0, 0, 0, 1])


def test_hermite_interpolation_is_exact_on_a_parabola() -> None:
    # p = 3t², from t = 1 to 3: 3, 6 and 27, 18; at t = 2: 12
    assert interpolate_hermite(3.0, 6.0, 27.0, 18.0, 2.0, 0.5) == pytest.approx(12.0)
    assert interpolate_hermite(3.0, 6.0, 27.0, 18.0, 2.0, 0.0) == 3.0
    assert interpolate_hermite(3.0, 6.0, 27.0, 18.0, 2.0, 1.0) == 27.0


def kink(at: float, a: float = 3000.0) -> Point:
    """Rest until t = 0, then accelerated."""
    t = max(at, 0.0)
    return (0.5 * a * t * t,), (a * t,)


def test_pvt_record_is_split_where_the_acceleration_jumps() -> None:
    # From -10 to 10 ms with the jump in the middle p1 = aT²/8 and v1 = aT/2, so the cubic is
    # s²(3 - 2s)·p1 - s²(1 - s)·v1·T = s²(2s - 1)/8·aT², worst of the eighths at s = 3/8: -9/2048·aT²
    assert find_max_deviation(kink, -0.01, 0.02, (1.0,)) == pytest.approx(9 / 2048 * 3000.0 * 0.02**2)
    cut = fit_longest_piece(kink, -0.01, 20, (0.00127,))
    assert cut.duration_ms < 20
    assert cut.max_deviation_counts <= 0.5
    assert fit_longest_piece(kink, 0.0, 20, (0.00127,)).duration_ms == 20


def test_shortest_record_is_used_despite_its_deviation_and_reports_it() -> None:
    cut = fit_longest_piece(lambda t: ((abs(t),), (1.0 if t > 0 else -1.0,)), -0.001, 20, (1e-6,))
    assert cut.duration_ms == 2
    assert cut.max_deviation_counts > 1.0


def test_straight_line_uses_the_longest_records() -> None:
    line = fit_longest_piece(lambda t: ((5.0 * t, -3.0 * t), (5.0, -3.0)), 1.0, 20, (0.001, 0.001))
    assert line.duration_ms == 20
    assert line.max_deviation_counts == pytest.approx(0.0, abs=1e-9)
