"""The simulator against what the firmware's own source does: what it says, when, and what it refuses.

Where each habit stands: docs/decisions/0027-grblhal.md.
"""

from __future__ import annotations

import math

import pytest

from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.wakeups import ManualClock
from tests.drivers.grblhal.bench import quirky

LATHE = b"G8G18G21G90G94G97\n"
RESET, STOP, HOLD, START, CANCEL, STATUS, FULL = (
    bytes([b]) for b in (0x18, 0x19, 0x82, 0x81, 0x85, 0x80, 0x87)
)


class Desk:
    """A hand at the other end of the wire."""

    def __init__(self, **quirks: object) -> None:
        self.clock = ManualClock()
        self.firmware = GrblFirmware(self.clock, quirky(**quirks))

    def say(self, data: bytes) -> list[str]:
        self.firmware.receive_bytes(data)
        return self.hear()

    def hear(self, seconds: float = 0.0) -> list[str]:
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self.clock.advance(0.01)
            self.firmware.advance()
        return [line for line in self.firmware.pop_output().decode().split("\r\n") if line]


def test_reset_in_motion_sends_alarm_then_banner_then_unlock_hint() -> None:
    desk = Desk()
    desk.say(LATHE + b"G1X50F600\n")
    desk.hear(1.0)
    alarm, banner, message = desk.say(RESET)
    assert alarm == "ALARM:3"
    assert banner.startswith("GrblHAL 1.1f")
    assert message == "[MSG:'$H'|'$X' to unlock]"
    (told,) = desk.say(FULL)
    assert told.startswith("<Alarm:3|")
    assert desk.say(b"G1X1F1\n") == ["error:9"]
    assert desk.say(b"$X\n") == ["[MSG:Caution: Unlocked]", "ok"]


def test_reset_at_rest_sends_only_its_banner() -> None:
    (banner,) = Desk().say(RESET)
    assert banner.startswith("GrblHAL")


def test_stop_command_stops_abruptly_without_reporting_lost_position() -> None:
    desk = Desk()
    desk.say(LATHE + b"M3S1000\nG1X50F600\n")
    desk.hear(1.0)
    assert desk.firmware.motion.speed == pytest.approx(10.0)
    assert desk.say(STOP) == ["[MSG:Stop]"]
    assert desk.firmware.abrupt_stop_count == 1
    assert desk.firmware.motion.speed == 0.0
    assert desk.firmware.programmed_rpm == 0.0
    assert desk.say(STATUS)[0].startswith("<Idle|")


def test_jog_ignores_feed_hold_and_rejects_lines_until_it_ends() -> None:
    desk = Desk()
    assert desk.say(LATHE + b"$J=G53X50F600\n") == ["ok", "ok"]
    desk.hear(0.5)
    desk.say(HOLD)
    desk.hear(0.5)
    assert desk.firmware.motion.speed == pytest.approx(10.0)
    assert desk.say(b"M5\n") == ["error:9"]
    desk.say(CANCEL)
    desk.hear(0.1)
    assert desk.say(STATUS)[0].startswith("<Idle|")
    assert desk.say(b"M5\n") == ["ok"]


def test_lines_are_not_read_during_feed_hold() -> None:
    desk = Desk()
    desk.say(LATHE + b"G1X50F600\n")
    desk.hear(0.5)
    desk.say(HOLD)
    assert desk.say(b"$G\n") == []
    desk.hear(0.2)
    assert desk.say(STATUS)[0].startswith("<Hold:0|")
    (told,) = [line for line in desk.say(START) if line.startswith("[GC:")]
    assert told == "[GC:G1 G54 G8 G18 G21 G90 G94 G97 G49 G98 G50 M5 M9 T0 F600 S0.]"


@pytest.mark.parametrize(("restore", "runs"), [(3, True), (1, False)])
def test_setting_63_decides_whether_the_spindle_restarts_after_a_hold(restore: int, runs: bool) -> None:
    desk = Desk(settings={63: float(restore)})
    desk.say(LATHE + b"M3S1000\nG1X50F600\n")
    desk.hear(0.5)
    desk.say(HOLD)
    desk.hear(0.2)
    desk.say(b"\x9e")
    assert desk.firmware.commanded_rpm == 0.0
    desk.say(START)
    assert (desk.firmware.commanded_rpm != 0.0) is runs


def test_critical_alarm_needs_a_reset_and_cannot_be_unlocked() -> None:
    desk = Desk()
    desk.firmware.raise_alarm(17)
    desk.hear()
    assert desk.say(b"$X\n") == ["error:79"]
    desk.say(RESET)
    assert desk.say(b"$X\n")[-1] == "ok"
    assert desk.say(STATUS)[0].startswith("<Idle|")


def test_reset_gets_no_reply_while_estop_is_pressed() -> None:
    desk = Desk()
    desk.firmware.active_pins = "E"
    desk.firmware.raise_alarm(10)
    desk.hear()
    assert desk.say(RESET) == []


def test_full_report_has_offsets_overrides_and_active_outputs() -> None:
    """``report.c`` of 2026; that of 2023 left the overrides out."""
    desk = Desk()
    desk.say(b"\x92")
    (full,) = desk.say(FULL)
    assert "|WCO:0.000,0.000,0.000|WCS:G54|Ov:90,100,100|A:|" in full
    assert "|FW:grblHAL" in full


def test_changed_values_are_in_the_next_report_and_offsets_come_later() -> None:
    desk = Desk()
    desk.say(FULL)
    desk.say(b"\x92")
    (plain,) = desk.say(STATUS)
    assert "|Ov:90,100,100" in plain
    desk.say(b"M3S500\n")
    assert desk.say(STATUS)[0].endswith("|A:S>")
    told = [line for _ in range(40) for line in desk.say(STATUS)]
    assert any("|WCO:" in line for line in told)
    assert not any("|WCO:" in line and "|Ov:" in line for line in told)


def test_settings_are_reported_with_their_number_of_decimals() -> None:
    desk = Desk()
    assert desk.say(b"$12=0.0005\n") == ["ok"]
    lines = desk.say(b"$$\n")
    assert "$12=0.001" in lines or "$12=0.000" in lines
    assert "$110=7620.000" in lines
    assert "$32=2" in lines
    assert desk.say(b"$999=1\n") == ["error:53"]
    assert desk.say(b"$110=fast\n") == ["error:2"]
    assert desk.say(b"$110=1e3\n") == ["ok"]  # and reads 1: what is written has to be read back
    assert "$110=1.000" in desk.say(b"$$\n")


def test_homing_is_rejected_if_disabled_or_not_enabled_for_single_axis() -> None:
    assert Desk().say(b"$HX\n") == ["error:5"]
    assert Desk(homing=1).say(b"$HX\n") == ["error:5"]
    assert Desk(homing=1).say(b"$H\n") == []
    locked = Desk(homing=7)
    assert locked.say(b"$X\n") == ["error:46"]
    locked.say(b"$HX\n")
    locked.hear(1.0)
    (told,) = locked.say(FULL)
    assert told.startswith("<Alarm:11|")
    assert "|H:0,1" in told
    locked.say(b"$HZ\n")
    locked.hear(1.0)
    (told,) = locked.say(FULL)
    assert told.startswith("<Idle|")
    assert "|H:1,5" in told


def test_receive_buffer_with_less_than_100_bytes_free_reads_nothing() -> None:
    """A cycle start that is sent behind a full buffer is never heard."""
    desk = Desk()
    desk.say(LATHE + b"G1X50F600\n")
    desk.hear(0.5)
    desk.say(HOLD)
    desk.hear(0.2)
    lines = b"G1X40F600\n" * 100
    desk.say(lines)
    assert desk.firmware.free_receive_byte_count == 100
    desk.say(START)
    assert desk.firmware.state_name == "Hold:0"
    assert desk.firmware.lost_byte_count == 0


@pytest.mark.parametrize("words", ["G3X1Z1", "G2X1Z-1"])
def test_arc_in_g18_is_measured_from_z_to_x(words: str) -> None:
    """Plane G18: Z is its first axis, X its second, G3 the way from Z+ to X+.

    A quarter of 1 mm about X 1: it begins at X-, from where G3 goes on to Z+, and G2 back to Z-.
    """
    desk = Desk()
    assert desk.say(LATHE + f"{words}I1K0F600\n".encode()) == ["ok", "ok"]
    (block,) = desk.firmware.motion.block_queue
    assert block.length_mm == pytest.approx(math.pi / 2)


def test_arc_that_rounds_to_zero_is_a_full_circle() -> None:
    desk = Desk()
    desk.say(LATHE + b"G3X0Z0.00000I10K0F600\n")
    (block,) = desk.firmware.motion.block_queue
    assert block.length_mm == pytest.approx(20.0 * math.pi)


@pytest.mark.parametrize(
    ("end", "answer"), [(20.004, "ok"), (20.0055, "ok"), (20.02, "error:33"), (21.0, "error:33")]
)
def test_arc_end_may_deviate_by_a_thousandth_of_its_radius(end: float, answer: str) -> None:
    """5 µm are free; beyond, a thousandth of 10 mm is."""
    assert Desk().say(LATHE + f"G3X{end}Z0I10K0F600\n".encode())[-1] == answer
