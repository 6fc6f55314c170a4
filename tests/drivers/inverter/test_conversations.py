"""Each family byte for byte: what is said and answered from the opening of the line to the spindle's stop.

Written from the manuals' and LinuxCNC's registers, apart from our code; the checksums are pymodbus's.
"""

from __future__ import annotations

import pytest
from pymodbus.framer.rtu import FramerRTU

from drivers.inverter.inverter_control import InverterControl
from drivers.inverter.inverter_spindle import create_inverter_control
from drivers.wakeups import ManualClock
from tests.drivers.inverter.benches import FOLDER, OWN, config

ECHO = ""  # the answer is the request

DELTA_OPENED = """
    06 2000 0001 >                  stop
    03 0902 0001 > 03 02 0003       what a dead line makes of it: nothing
    06 0902 0001 >                  ramp down
    03 0903 0001 > 03 02 000F       after 1.5 s, in tenths
    03 0902 0001 > 03 02 0001
    03 0903 0001 > 03 02 000F
    03 0200 0001 > 03 02 0005       the frequency comes by RS-485
    03 0201 0001 > 03 02 0003       run and stop too
    03 0100 0001 > 03 02 1770       60 Hz at most
"""
DELTA_STANDS = """
    03 2100 0001 > 03 02 0000
    03 2101 0001 > 03 02 0000
    03 2102 0001 > 03 02 {set}
    03 2103 0001 > 03 02 0000
    03 2104 0001 > 03 02 0000
"""
DELTA_TURNS = """
    06 2001 07D0 >                  20 Hz
    06 2000 {run} >
    03 2100 0001 > 03 02 0000       each register alone
    03 2101 0001 > 03 02 {status}   runs
    03 2102 0001 > 03 02 07D0
    03 2103 0001 > 03 02 07D0
    03 2104 0001 > 03 02 0019       2.5 A
"""
HITACHI_OPENED = """
    05 0000 0000 >                  coil 1 off: stop
    03 113C 0001 > 03 02 0002       C076
    06 113C 0004 >                  ramp down
    03 113D 0001 > 03 02 0096       C077, 1.5 s in hundredths
    03 113C 0001 > 03 02 0004
    03 113D 0001 > 03 02 0096
    03 1200 0001 > 03 02 0003       A001
    03 1201 0001 > 03 02 0003       A002
    03 1203 0001 > 03 02 0258       A004, 60 Hz in tenths
"""
HITACHI_STANDS = """
    01 0000 0002 > 01 01 00
    01 000E 000A > 01 02 0400       ready
    03 0000 0002 > 03 04 0000 {set}
    03 1000 0003 > 03 06 0000 0000 0000
"""
HITACHI_TURNS = """
    10 0000 0002 04 0000 07D0 > 10 0000 0002
    05 0001 {back} >                direction, then run
    05 0000 FF00 >
    01 0000 0002 > 01 01 {coils}
    01 000E 000A > 01 02 {state}    runs, ready, at speed
    03 0000 0002 > 03 04 0000 07D0
    03 1000 0003 > 03 06 0000 07D0 00FA
"""
HUANYANG_OPENED = """
    03 01 08 > 03 01 00             stop
    01 03 01 0000 > 01 02 01 02     PD001: run and stop by RS-485
    01 03 02 0000 > 01 02 02 02     PD002: the frequency too
    01 03 05 0000 > 01 03 05 1770   PD005: 60 Hz at most
"""
HUANYANG_LOOK = """
    03 01 {word} > 03 01 {state}
    04 01 00 > 04 03 00 {set}
    04 01 01 > 04 03 01 {out}
    04 01 02 > 04 03 02 0019
"""
HUANYANG_STANDS = HUANYANG_LOOK.format(word="08", state="00", set="{set}", out="0000")
HUANYANG_TURNS = """
    05 02 07D0 >                    20 Hz
    03 01 {word} > 03 01 {state}
""" + HUANYANG_LOOK.format(word="{word}", state="{state}", set="07D0", out="07D0")

OWN_OPENED = """
    10 0001 0001 02 0000 > 10 0001 0001     stop
    03 0180 0001 > 03 02 0002       P1-01
    03 0181 0001 > 03 02 0002       P1-02
    03 0428 0001 > 03 02 0000       P5-04
    03 0435 0001 > 03 02 000F       P5-09, 1.5 s in tenths
    03 0303 0001 > 03 02 0258       P2-04, 60 Hz in tenths
"""
OWN_LOOK = """
    03 0001 0001 > 03 02 {command}
    03 0020 0007 > 03 0E {status} 0000 0000 {set} {out} 08FC 0019
"""
OWN_STANDS = OWN_LOOK.format(command="0000", status="0004", set="{set}", out="0000")
OWN_TURNS = """
    10 0002 0001 02 07D0 > 10 0002 0001     20 Hz
    10 0001 0001 02 {command} > 10 0001 0001
""" + OWN_LOOK.format(command="{command}", status="{status}", set="07D0", out="07D0")


def sealed(body: str) -> bytes:
    """With unit 1 before it and its checksum behind it."""
    frame = bytes.fromhex("01" + body)
    return frame + FramerRTU.compute_CRC(frame).to_bytes(2, "big")


class ScriptedLine:
    """Answers what it expects, in order; anything else is a failure."""

    def __init__(self, clock: ManualClock) -> None:
        self.clock = clock
        self.left: list[tuple[bytes, bytes]] = []
        self._come = b""

    def expect(self, script: str) -> None:
        """Lines of ``request > answer  remark``; an answer left out repeats the request."""
        for line in filter(None, map(str.strip, script.splitlines())):
            request, _, rest = line.partition(">")
            answer = rest.split("   ")[0].strip()
            answer = answer if answer and answer[0] in "0123456789ABCDEF" else ECHO
            self.left.append((sealed(request), sealed(answer or request)))

    def opened(self) -> ScriptedLine:
        return self

    def send(self, data: bytes) -> None:
        expected, answer = self.left.pop(0)
        assert data == expected, f"said {data.hex(' ')}, expected {expected.hex(' ')}"
        self._come = answer

    def receive(self, timeout_s: float) -> bytes:
        self.clock.advance(min(timeout_s, 0.02))
        come, self._come = self._come, b""
        return come

    def discard_input(self) -> None:
        self._come = b""

    def close(self) -> None:
        """Nothing to let go."""


def talk(family: str, opened: str, stands: str, *turns: tuple[float, str, str]) -> InverterControl:
    """Open it, make it turn by each of ``turns`` (Hz, script, word for stop), and stop it."""
    clock = ManualClock()
    line = ScriptedLine(clock)
    one = create_inverter_control(config(family), line.opened, clock, FOLDER)
    line.expect(opened)
    for _ in range(2 if family == "huanyang" else 1):  # ten good answers, or one
        line.expect(stands.format(set="0000"))
    one.open_and_check_line()
    for hz, script, stop in turns:
        line.expect(script)
        one.commanded_hz = hz
        one.run_exchange()
        assert not line.left
        assert one.last_poll is not None
        assert (one.last_poll.inverter_state.signed_output_hz, one.last_poll.inverter_state.current_a) == (
            hz,
            2.5,
        )
        line.expect(stop + stands.format(set="07D0"))
        one.commanded_hz = 0.0
        one.run_exchange()
        assert not line.left
    assert one.failure == ""
    return one


def test_delta_conversation_matches_byte_for_byte() -> None:
    forward = DELTA_TURNS.format(run="0012", status="0003")
    back = DELTA_TURNS.format(run="0022", status="001B")
    stop = "06 2000 0001 >\n"
    one = talk("delta-vfdb", DELTA_OPENED, DELTA_STANDS, (20.0, forward, stop), (-20.0, back, stop))
    assert one.warnings == ()


def test_hitachi_conversation_matches_byte_for_byte() -> None:
    forward = HITACHI_TURNS.format(back="0000", coils="01", state="2500")
    back = HITACHI_TURNS.format(back="FF00", coils="03", state="2700")
    stop = "05 0000 0000 >\n"
    one = talk("hitachi-wj200", HITACHI_OPENED, HITACHI_STANDS, (20.0, forward, stop), (-20.0, back, stop))
    assert one.warnings == ()


def test_huanyang_conversation_matches_byte_for_byte() -> None:
    forward = HUANYANG_TURNS.format(word="01", state="09")
    back = HUANYANG_TURNS.format(word="11", state="2D")
    stop = "03 01 08 > 03 01 00\n"
    one = talk("huanyang", HUANYANG_OPENED, HUANYANG_STANDS, (20.0, forward, stop), (-20.0, back, stop))
    assert len(one.warnings) == 1


def test_conversation_of_an_own_family_file_matches_byte_for_byte() -> None:
    forward = OWN_TURNS.format(command="0001", status="0005")
    back = OWN_TURNS.format(command="0002", status="0007")
    stop = "10 0001 0001 02 0000 > 10 0001 0001\n"
    one = talk(OWN, OWN_OPENED, OWN_STANDS, (20.0, forward, stop), (-20.0, back, stop))
    assert one.warnings == ()


def test_scripted_line_detects_a_wrong_byte() -> None:
    line = ScriptedLine(ManualClock())
    line.expect("06 2000 0001 >")
    with pytest.raises(AssertionError, match="expected 01 06 20 00 00 01 43 ca"):
        line.send(sealed("06 2000 0002"))
