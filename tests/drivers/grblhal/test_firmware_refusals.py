"""What the simulator refuses, with the numbers that the firmware's ``errors.h`` has for it."""

from __future__ import annotations

import pytest

from tests.drivers.grblhal.test_firmware_habits import LATHE, STATUS, Desk

# Numbers of errors.h: bad number, unknown statement, not idle, unknown word, no feed, line number,
# no target, no such port, spindle stands, too fast for the slide.
BAD_NUMBER, STATEMENT, NOT_IDLE, UNKNOWN, NO_FEED, LINE_NUMBER = 2, 3, 8, 20, 22, 27
NO_TARGET, NO_PORT, SPINDLE_STANDS, TOO_FAST = 33, 39, 41, 43


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("G1X", BAD_NUMBER),
        ("G1X1..2F60", BAD_NUMBER),
        ("$what", STATEMENT),
        ("$HQ", STATEMENT),
        ("G5X1", UNKNOWN),
        ("M17", UNKNOWN),
        ("M64P16", NO_PORT),
        ("M65P-1", NO_PORT),
        ("G1X1Z1", NO_FEED),
        ("$J=G53X5", NO_FEED),
        ("N10000001G1X1F60", LINE_NUMBER),
        ("G2X1Z1I9K9F60", NO_TARGET),
        ("G33Z5K0", NO_PORT),
        ("G33Z5K1", SPINDLE_STANDS),
    ],
)
def test_invalid_line_is_rejected_and_moves_nothing(line: str, error: int) -> None:
    desk = Desk()
    desk.say(LATHE)
    assert desk.say(f"{line}\n".encode()) == [f"error:{error}"]
    desk.hear(0.2)
    assert desk.firmware.motion.position == (0.0, 0.0)
    assert desk.say(STATUS)[0].startswith("<Idle|")
    assert desk.say(b"M8\n") == [f"error:{error}"]
    assert desk.say(b"\n") == ["ok"]  # an empty line ends a standing error
    assert desk.say(b"M8\n") == ["ok"]


def test_arc_in_a_plane_other_than_g18_is_rejected() -> None:
    desk = Desk()
    desk.say(LATHE + b"G17\n")
    assert desk.say(b"G2X1Z1I1F60\n") == [f"error:{NO_TARGET}"]


@pytest.mark.parametrize(("line", "built"), [("G8", False), ("G96S100", False), ("G8", True)])
def test_lathe_words_require_lathe_mode(line: str, built: bool) -> None:
    desk = Desk(lathe=False, built_for_lathes=built)
    answer = desk.say(f"{line}\n".encode())
    assert answer == (["ok"] if built else [f"error:{UNKNOWN}"])


def test_feed_per_rev_and_threading_are_rejected_without_an_encoder() -> None:
    desk = Desk(encoder=False)
    desk.say(b"G8G18G21G90G94\nM3S600\n")
    desk.hear(2.0)
    assert desk.say(b"G95\n") == [f"error:{UNKNOWN}"]
    assert desk.say(b"G33Z5K1\n") == [f"error:{UNKNOWN}"]


def test_thread_too_fast_for_the_axis_is_rejected() -> None:
    """20 mm at 600 rpm are 12 000 mm/min of 7620."""
    desk = Desk()
    desk.say(LATHE + b"M3S600\n")
    desk.hear(5.0)
    assert desk.say(b"G33Z50K20\n") == [f"error:{TOO_FAST}"]


def test_jog_and_settings_are_rejected_while_a_line_moves() -> None:
    desk = Desk()
    desk.say(LATHE + b"G1X50F600\n")
    desk.hear(0.5)
    assert desk.say(b"$J=G53X5F600\n") == [f"error:{NOT_IDLE}"]
    assert desk.say(b"$110=5000\n") == [f"error:{NOT_IDLE}"]
    desk.hear(10.0)
    assert desk.firmware.motion.position == pytest.approx((50.0, 0.0))


def test_unlocking_an_unlocked_controller_replies_only_ok() -> None:
    assert Desk().say(b"$X\n") == ["ok"]
