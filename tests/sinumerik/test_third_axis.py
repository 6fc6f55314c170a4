"""Signed travel of C by every form of a target: the tables of the specification, and 20 000 random moves."""

from __future__ import annotations

import random

import pytest

from core.interpreter.sinumerik.motion import third_axis
from core.interpreter.sinumerik.motion.third_axis import (
    AxisTargetError,
    check_axis_range,
    compute_linear_travel,
    compute_modulo_travel,
)
from core.language.sinumerik.sinumerik_words import PositionMode
from tests.coded import raises_code
from tests.sinumerik.lathe import LINEAR, good, refused, setup

TABLE = [  # start, target, AC, DC, ACP, ACN
    (0, 10, +10, +10, +10, -350),
    (0, 55.7, +55.7, +55.7, +55.7, -304.3),
    (0, 180, +180, +180, +180, -180),
    (0, 190, +190, -170, +190, -170),
    (0, 350, +350, -10, +350, -10),
    (10, 0, -10, -10, +350, -10),
    (10, 10, 0, 0, 0, 0),
    (10, 190, +180, +180, +180, -180),
    (90, 350, +260, -100, +260, -100),
    (180, 0, -180, +180, +180, -180),
    (270, 180, -90, -90, +270, -90),
    (350, 10, -340, +20, +20, -340),
    (-30, 10, -320, +40, +40, -320),
    (-30, 350, +20, +20, +20, -340),
    (725, 0, -5, -5, +355, -5),
]
FORMS = (PositionMode.AC, PositionMode.DC, PositionMode.ACP, PositionMode.ACN)


@pytest.mark.parametrize("row", TABLE, ids=lambda row: f"{row[0]}-{row[1]}")
def test_modulo_travel_matches_reference_table(row: tuple[float, ...]) -> None:
    start, target, *travels = row
    for form, travel in zip(FORMS, travels, strict=True):
        assert compute_modulo_travel(form, target, start) == pytest.approx(travel, abs=1e-9)


@pytest.mark.parametrize("row", TABLE, ids=lambda row: f"{row[0]}-{row[1]}")
def test_programmed_modulo_moves_match_reference_table(row: tuple[float, ...]) -> None:
    start, target, *travels = row
    words = [f"C={form}({target})" for form in FORMS]
    for word, travel in zip([f"C{target}", *words], [travels[0], *travels], strict=True):
        (block,) = good(f"G0 {word}", setup(start=(0.0, 0.0, start)))
        assert block.c - block.c0 == pytest.approx(travel, abs=1e-9)
        assert (block.mc - target) % 360 == pytest.approx(0, abs=1e-9)


def test_modulo_moves_match_manufacturer_example() -> None:
    blocks = good("G0 C=ACP(100)\nC=ACN(300)\nC=ACP(240)\nC=AC(0)", setup(start=(0.0, 0.0, 0.0)))
    assert [b.c - b.c0 for b in blocks] == pytest.approx([100, -160, 300, -240])
    assert [b.mc % 360 for b in blocks] == pytest.approx([100, 300, 240, 0])


@pytest.mark.parametrize(
    ("start", "by", "shown"), [(350, 20, 10), (10, -20, 350), (0, 360, 0), (0, -1080, 0)]
)
def test_incremental_moves_can_be_any_number_of_revolutions(start: float, by: float, shown: float) -> None:
    for text in (f"G0 C=IC({by})", f"G91 G0 C{by}"):
        (block,) = good(text, setup(start=(0.0, 0.0, start)))
        assert block.c - block.c0 == pytest.approx(by)
        assert block.mc % 360 == pytest.approx(shown)


def test_target_form_overrides_g91() -> None:
    (block,) = good("G91 G0 C=AC(10)", setup(start=(0.0, 0.0, 300.0)))
    assert block.c - block.c0 == pytest.approx(-290)


def test_random_20_000_moves_end_at_their_targets() -> None:
    dice, at = random.Random(7), 0.0
    for _ in range(20_000):
        target = round(dice.uniform(0, 359.4), dice.randrange(4))
        ways = {form: compute_modulo_travel(form, target, at) for form in FORMS}
        for way in ways.values():
            off = (at + way - target) % 360
            assert min(off, 360 - off) < 1e-6
        assert (
            abs(ways[PositionMode.DC]) <= min(abs(ways[PositionMode.ACP]), abs(ways[PositionMode.ACN])) + 1e-9
        )
        assert abs(ways[PositionMode.DC]) <= 180 + 1e-9
        assert 0 <= ways[PositionMode.ACP] < 360
        assert -360 < ways[PositionMode.ACN] <= 0
        form = dice.choice([*FORMS, PositionMode.IC])
        at += dice.uniform(-2000, 2000) if form is PositionMode.IC else ways[form]


def test_random_20_000_program_moves_end_at_their_targets() -> None:
    """Forms in turn; the blocks follow each other without a jump, and each ends at its target."""
    dice = random.Random(11)
    rows = [(dice.choice(FORMS), round(dice.uniform(0, 359.99), 2)) for _ in range(20_000)]
    blocks = good("\n".join(f"G0 C={form}({value})" for form, value in rows))
    assert len(blocks) == len(rows)
    at = 0.0
    for (form, value), block in zip(rows, blocks, strict=True):
        assert block.c0 == pytest.approx(at, abs=1e-9)
        off = (block.mc - value) % 360
        assert min(off, 360 - off) < 1e-6
        assert form is not PositionMode.ACP or block.c >= block.c0
        assert form is not PositionMode.ACN or block.c <= block.c0
        at = block.c


@pytest.mark.parametrize("noise", [1e-12, -1e-12, 3e-10, -3e-10])
def test_rounding_noise_causes_no_extra_revolution(noise: float) -> None:
    """A position that is 0 but for binary noise is 0: no whole turn comes of it."""
    for form in FORMS:
        assert compute_modulo_travel(form, 0.0, noise) == pytest.approx(0, abs=1e-9)
        assert compute_modulo_travel(form, 0.0, 720 + noise) == pytest.approx(0, abs=1e-9)
    assert compute_modulo_travel(PositionMode.DC, 180.0, noise) == pytest.approx(180, abs=1e-8)
    assert compute_modulo_travel(PositionMode.AC, 10.0, 360 + noise) == pytest.approx(10, abs=1e-8)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("value", [-1.0, 360.0, 400.0, -0.001])
def test_modulo_axis_targets_are_limited_to_0_to_below_360(form: PositionMode, value: float) -> None:
    with pytest.raises(AxisTargetError) as told:
        compute_modulo_travel(form, value, 0.0)
    assert told.value.alarm_number == 16830


# --- the linear axis -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("start", "word", "travel"),
    [
        (0, "C350", +350),
        (350, "C10", -340),
        (-30, "C10", +40),
        (-30, "C-350", -320),
        (0, "C-360", -360),
        (0, "C360", +360),
    ],
)
def test_linear_axis_moves_by_programmed_travel(start: float, word: str, travel: float) -> None:
    (block,) = good(f"G0 {word}", setup(LINEAR, (0.0, 0.0, start)))
    assert block.c - block.c0 == pytest.approx(travel)
    assert block.mc == pytest.approx(start + travel)


@pytest.mark.parametrize(
    ("start", "text"),
    [(350, "G0 C=IC(20)"), (0, "G0 C=IC(400)"), (0, "TRANS C30\nG0 C350"), (0, "G0 C-360.001")],
)
def test_target_beyond_linear_axis_range_is_rejected(start: float, text: str) -> None:
    error = refused(text, setup(LINEAR, (0.0, 0.0, start)))
    assert error.code == str(third_axis.WRONG_AXIS_RANGE)
    assert "axis C" in error.message


def test_offset_within_linear_axis_range_is_accepted() -> None:
    (block,) = good("TRANS C30\nG0 C330", setup(LINEAR, (0.0, 0.0, 0.0)))
    assert block.mc == pytest.approx(360)
    assert block.c == pytest.approx(330)


@pytest.mark.parametrize(("form", "alarm"), [("DC", "16800"), ("ACP", "16810"), ("ACN", "16820")])
def test_rotary_target_forms_are_rejected_for_linear_axis(form: str, alarm: str) -> None:
    assert refused(f"G0 C={form}(10)", setup(LINEAR)).code == alarm
    with pytest.raises(AxisTargetError):
        compute_linear_travel(PositionMode(form), 10.0, 0.0)


def test_range_limit_itself_is_within_range() -> None:
    check_axis_range(360.0)
    check_axis_range(-360.0)
    with raises_code(AxisTargetError, "10720"):
        check_axis_range(360.01)
