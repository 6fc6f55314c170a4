"""Byte for byte: the handshake, reports, override steps, numbers, and the count of unanswered bytes."""

from __future__ import annotations

import pytest

from app.compose.backends.grblhal_backend import create_grblhal_config
from core.block_ports import ArcOperation, LineOperation, RapidOperation, ThreadOperation
from core.ports import DriverError
from drivers.grblhal.grblhal_codes import format_block, format_jog, number
from drivers.grblhal.grblhal_machine import GrblMachine
from drivers.grblhal.grblhal_operator import encode_override_steps
from drivers.grblhal.grblhal_report import parse_identity, parse_report
from drivers.grblhal.grblhal_scripts import NO_REPORTS_TEXT
from drivers.grblhal.grblhal_transport import LineSender
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.grblhal.bench import grbl_machine

FULL = (
    b"<Idle|MPos:1.000,0.000,-2.500|Bf:100,1023|FS:0,0,0|WCO:0.000,0.000,0.000|Ov:100,100,100|D:0|H:0|T:0"
    b"|FW:grblHAL>\r\n"
)
MODES = b"[GC:G0 G54 G8 G18 G21 G90 G94 G97 G49 G98 G50 M5 M9 T0 F0 S0.]\r\nok\r\n"
IDENTITY = (
    b"[VER:1.1f.20260817:]\r\n[OPT:VNML+,100,1024,3,16]\r\n[AXS:3:XYZ]\r\n[NEWOPT:ENUMS,LATHE,EXPR,TC,SED]\r\n"
    b"[DRIVER:Simulator]\r\nok\r\n"
)


class ScriptedWire:
    """Answers what it expects, in order; anything else is a failure. Status polls in between are ignored."""

    def __init__(self, *conversation: tuple[bytes, bytes]) -> None:
        self.left = list(conversation)
        self._answers = b""

    def read(self) -> bytes:
        data, self._answers = self._answers, b""
        return data

    def write(self, data: bytes) -> None:
        if not self.left:
            return
        expected, answer = self.left.pop(0)
        assert data == expected
        self._answers += answer

    def close(self) -> None:
        """Nothing to let go."""


def test_connection_handshake_is_sent_byte_for_byte() -> None:
    wire = ScriptedWire(
        (b"\x87", FULL),
        (b"\n", b"ok\r\n"),
        (b"$G\n", MODES),
        (b"$I\n", IDENTITY),
        (b"$$\n", b"$10=511\r\n$13=1\r\n$32=2\r\nok\r\n"),
        (b"$13=0\n", b"ok\r\n"),
        (b"$10=1535\n", b"ok\r\n"),
        (b"$$\n", b"$10=1535\r\n$13=0\r\n$32=2\r\nok\r\n"),
        (b"\x87", FULL),
        (b"M5\n", b"ok\r\n"),
        (b"M9\n", b"ok\r\n"),
        (b"\n", b"ok\r\n"),
        (b"$G\n", MODES),
        (b"G8G18G21G90G94G97G54\n", b"ok\r\n"),
        (b"$G\n", MODES),
        (b"\x87", FULL),
    )
    machine = GrblMachine(create_grblhal_config(grbl_machine()), ManualClock(), wire)
    assert not wire.left
    assert machine.controller.is_ready
    assert machine.axes.sample().actual == (1.0, -2.5, 0.0)
    assert machine.controller.line_sender.free_bytes == 896  # of 1024 bytes, 128 are never used


def test_setting_that_is_not_retained_is_rejected() -> None:
    wire = ScriptedWire(
        (b"\x87", FULL),
        (b"\n", b"ok\r\n"),
        (b"$G\n", MODES),
        (b"$I\n", IDENTITY),
        (b"$$\n", b"$10=1535\r\n$13=0\r\n$32=0\r\nok\r\n"),
        (b"$32=2\n", b"ok\r\n"),
        (b"$$\n", b"$10=1535\r\n$13=0\r\n$32=0\r\nok\r\n"),
    )
    with raises_code(DriverError, "driver", "$32=2"):
        GrblMachine(create_grblhal_config(grbl_machine()), ManualClock(), wire)


@pytest.mark.parametrize("answer", [b"", b"hello\r\n", b"<Idle>\r\n"])
def test_device_that_is_not_a_controller_is_rejected(answer: bytes) -> None:
    with raises_code(DriverError, "driver", "/dev/ttyACM0: ", NO_REPORTS_TEXT):
        GrblMachine(create_grblhal_config(grbl_machine()), ManualClock(), ScriptedWire((b"\x87", answer)))


@pytest.mark.parametrize(
    "line",
    [
        "<Idle|MPos:1.0,0.0,2.0",
        "<Idlw|MPos:1.0,0.0,2.0>",
        "<Idle|MPos:1.0,0.O,2.0>",
        "<Idle|MPos:1.0,0.0,2..0>",
        "<Idle|MP0s:1.0,0.0,2.0>",
        "<Idle|MPos:1.0,0.0,2.0|Bf:1x,3>",
        "<Run|MPos:1.0,0.0,2.0|Ln:>",
        "<Idle|MPos:nan,0.0,2.0>",
        "<Hold:x|MPos:1.0,0.0,2.0>",
        "<Idle|MPos:1.0,0.0,2.0|D:7>",
    ],
)
def test_damaged_report_is_ignored(line: str) -> None:
    assert parse_report(line) is None


@pytest.mark.parametrize("line", ["<Idle|MPos:1.0,2.0|WPos:3.0,4.0>", "<Idle|WPos:3.0,4.0|MPos:1.0,2.0>"])
def test_report_with_two_positions_uses_the_machine_position(line: str) -> None:
    report = parse_report(line)
    assert report is not None
    assert report.position == (1.0, 2.0)


def test_full_report_is_parsed() -> None:
    report = parse_report(
        "<Hold:1|MPos:-1.234,0.000,5.600|Bf:98,1000|Ln:33|FS:500,1000,998|Pn:EH|Ov:83,50,100|D:1>"
    )
    assert report is not None
    assert (report.state, report.sub, report.moves) == ("Hold", 1, True)
    assert report.position == (-1.234, 0.0, 5.6)
    assert (report.free, report.line, report.measured, report.pins) == (98, 33, 998.0, "EH")
    assert (report.overrides, report.diameter) == ((83, 50, 100), True)


@pytest.mark.parametrize(
    ("told", "percent", "expected"),
    [
        (100, 100, ""),
        (100, 83, "92 92 93 93 93"),
        (100, 120, "91 91"),
        (100, 147, "91 91 91 91 91 94 94 94"),
        (100, 10, "92 92 92 92 92 92 92 92 92"),
        (50, 49, "94"),  # a reset would let slides leap that creep
        (50, 90, "91 91 91 91"),
        (150, 60, "90 92 92 92 92"),  # 100 % lies on the way
        (10, 19, "91 94"),
        (191, 200, "94 91"),  # a coarse step would be cut short at 200
    ],
)
def test_override_is_encoded_in_steps(told: int, percent: int, expected: str) -> None:
    assert encode_override_steps(percent, told) == bytes.fromhex(expected)


def test_every_override_fits_the_command_queue_and_approaches_steadily() -> None:
    worth = {0x91: 10, 0x92: -10, 0x93: 1, 0x94: -1}
    for told in range(10, 201):
        for percent in range(10, 201):
            at, way = told, []
            for step in encode_override_steps(percent, told):
                at = 100 if step == 0x90 else min(max(at + worth[step], 10), 200)
                way.append(at)
            assert at == percent
            assert len(way) < 16
            assert all(min(told, percent) - 5 <= place <= max(told, percent) + 5 for place in way)


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (-1e-9, "0"), (25.4, "25.4"), (0.00127, "0.00127"), (-101.6, "-101.6"), (1 / 3, "0.33333")],
)
def test_numbers_have_a_resolution_of_a_hundredth_micrometer(value: float, text: str) -> None:
    assert number(value) == text


def test_blocks_are_formatted_as_lines() -> None:
    assert format_block(RapidOperation(1.0, 2.0, 127.0), 7, 127.0, 1.0) == "N7G0X1Z2"
    assert format_block(RapidOperation(1.0, 2.0, 50.0), 7, 127.0, 1.0) == "N7G1X1Z2F3000"
    assert (
        format_block(RapidOperation(1.0, 2.0, 50.0), 7, 127.0, 1.25) == "N7G1X1Z2F2400"
    )  # no override speeds up a rapid
    assert format_block(LineOperation(1.0, -2.0, 0.5), 8, 127.0, 1.5) == "N8G1X1Z-2F30"
    assert format_block(ThreadOperation(1.0, 0.0, 1.0, -2.0, 1.27), 9, 127.0, 1.0) == "N9G33X1Z-2K1.27"
    # X by 3 and Z by 4 are 5 along the way: five quarters of the lead, which counts along Z.
    assert format_block(ThreadOperation(4.0, 0.0, 1.0, -4.0, 1.6), 9, 127.0, 1.0) == "N9G33X1Z-4K2"
    # From Z+ towards X+ is counter-clockwise in the plane of Z and X: G3.
    assert (
        format_block(ArcOperation(0.0, 1.0, 1.0, 0.0, 0.0, 0.0, True, 1.0), 1, 127.0, 1.0)
        == "N1G3X1Z0I0K-1F60"
    )
    assert (
        format_block(ArcOperation(1.0, 0.0, 0.0, 1.0, 0.0, 0.0, False, 1.0), 1, 127.0, 1.0)
        == "N1G2X0Z1I-1K0F60"
    )
    assert format_block(LineOperation(0.0, 0.0, 1.0), 9_000_001, 127.0, 1.0).startswith("N1G1")
    assert format_jog("X", -1.5, 10.0) == "$J=G53G21G90X-1.5F600"


def test_unanswered_bytes_never_exceed_the_buffer() -> None:
    sent: list[bytes] = []
    stream = LineSender(sent.append)
    stream.set_buffer_size(328)  # of which 200 may be used
    line = "N1G1X1.00000Z1.00000F100"  # 25 bytes with its end
    for _ in range(20):
        stream.send_line(line, 0.0)
    assert len(sent) == 8
    assert not stream.can_send_now("x")
    stream.assign_reply(0)
    stream.send_waiting_lines(0.0)
    assert len(sent) == 9


def test_unexpected_reply_is_detected() -> None:
    stream = LineSender(lambda _: None)
    assert stream.assign_reply(0) is None


@pytest.mark.parametrize(
    ("lines", "reason"),
    [
        ([], "no-grblhal"),
        (["[VER:1.1f:]", "[OPT:V]"], "no-grblhal"),
        (["[VER:1:]", "[OPT:V,16,128]"], "small-buffer"),
    ],
)
def test_controller_identity_is_validated(lines: list[str], reason: str) -> None:
    with raises_code(DriverError, "driver") as told:
        parse_identity(lines)
    assert told.value.reason == reason
