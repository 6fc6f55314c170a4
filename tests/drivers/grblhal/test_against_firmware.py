"""The simulator and the simulator of the firmware itself get the same bytes, and the answers are compared.

Runs where TURNDESK_GRBLHAL_SIM names the simulator's program (grblHAL/Simulator with its core), as it comes.
"""

from __future__ import annotations

import os
import re
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from core.ports import Clock
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.wakeups import ManualClock, RealClock
from tests.drivers.grblhal.bench import quirky
from tests.drivers.grblhal.test_like_the_simulator import AS_IT_COMES
from tests.free_port import free_port

_VARIABLE = "TURNDESK_GRBLHAL_SIM"
SIMULATOR = os.environ.get(_VARIABLE, "")
pytestmark = pytest.mark.skipif(not SIMULATOR, reason=f"{_VARIABLE} names no firmware simulator")
_GUARD = 30.0  # s; a computer may be busy

FULL, STATUS, HOLD, START, RESET = b"\x87", b"\x80", b"\x82", b"\x81", b"\x18"
LATHE = b"$32=2\n"
# What is said, and which of them the answers depend on; each begins behind a reset, in lathe mode.
TALKS = {
    "modes": (b"G8G18G21G90G94G97G54\n", b"$G\n"),
    "behind a reset": (b"G7G20G91G95\n", RESET, b"$G\n"),
    "a feed that nobody gave": (b"G1X1\n",),
    "an error sticks until an empty line": (b"G1X1\n", b"G0X0\n", b"\n", b"G0X0\n"),
    "a command that is none": (b"G5.9\n", b"\n", b"hello\n"),
    "an arc that misses its end": (b"G18\n", b"G2X5Z1I5K5F100\n"),
    "a thread without an encoder": (b"G18\n", b"G33Z-1K1\n"),
    "an output and an input that are not there": (b"M64P0\n", b"\n", b"M66P0L0\n"),
    "settings": (b"$999=1\n", b"$110=1e3\n", b"$110=12,5\n", b"$12=0.0005\n", b"$20=1\n"),
    "homing that is off": (b"$H\n", b"$HX\n"),
    "jogs": (b"$J=G91X1\n", b"$J=G91X0.01F100\n"),
    "a number of a line": (b"N10000000G0X0\n",),
    "offsets": (b"G10L2P1X0Y0Z0\n", b"G92.1\n", b"G49\n"),
    "spindle and coolant": (b"M3S500\n", b"M8\n", b"M7\n", b"M9\n", b"M5\n"),
}


class Real:
    """The simulator on a socket of this computer."""

    def __init__(self, folder: Path) -> None:
        port = free_port()
        self._process = subprocess.Popen(
            [SIMULATOR, "-p", str(port), "-e", str(folder / "eeprom")],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._clock: Clock = RealClock()
        self._socket = self._reached(port)
        self._inbox = b""

    def _reached(self, port: int) -> socket.socket:
        by = self._clock.now() + _GUARD
        while True:
            try:
                return socket.create_connection(("127.0.0.1", port), _GUARD)
            except OSError:
                assert self._clock.now() < by, "the simulator does not listen"
                self._clock.sleep_until(self._clock.now() + 0.05)

    def say(self, data: bytes) -> list[str]:
        """What it says to that, up to its answer: an ok, an error, a report, a banner."""
        self._socket.sendall(data)
        told: list[str] = []
        while not told or not _answers(told[-1], data):
            while b"\n" not in self._inbox:
                self._socket.settimeout(_GUARD)
                self._inbox += self._socket.recv(4096)
            line, _, self._inbox = self._inbox.partition(b"\n")
            told += [line.decode("ascii").strip()] if line.strip() else []
        return told

    def close(self) -> None:
        """It ends."""
        self._socket.close()
        self._process.kill()
        self._process.wait(_GUARD)


class Ours:
    """The simulator as the simulator comes."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.firmware = GrblFirmware(self.clock, quirky(**AS_IT_COMES, signals="D", lathe=False))

    def say(self, data: bytes) -> list[str]:
        """The same."""
        self.firmware.receive_bytes(data)
        told: list[str] = []
        for _ in range(3000):
            told += [
                line.strip()
                for line in self.firmware.pop_output().decode("ascii").split("\n")
                if line.strip()
            ]
            if told and _answers(told[-1], data):
                break
            self.clock.advance(0.01)
        return told


def _answers(line: str, data: bytes) -> bool:
    """Whether it is what ends the answer to this: a report, a banner, an ok or an error."""
    if data in {FULL, STATUS}:
        return line.startswith("<")
    return line.startswith("Grbl") if data == RESET else line == "ok" or line.startswith("error:")


@pytest.fixture(scope="module")
def real(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Real]:
    end = Real(tmp_path_factory.mktemp("simulator"))
    end.say(STATUS)
    end.say(LATHE)
    yield end
    end.close()


@pytest.fixture
def ours() -> Ours:
    end = Ours()
    end.say(STATUS)
    end.say(LATHE)
    return end


def asked_anew(end: Real | Ours) -> None:
    """From a reset on, unlocked: the jog before may have been under way."""
    for data in (RESET, b"\n", b"$X\n"):
        end.say(data)


@pytest.mark.parametrize("talk", TALKS)
def test_simulator_replies_like_the_firmware(real: Real, ours: Ours, talk: str) -> None:
    answers: list[list[list[str]]] = []
    for end in (real, ours):
        asked_anew(end)
        answers.append([_plain(end.say(data)) for data in TALKS[talk]])
    for said, theirs, our in zip(TALKS[talk], *answers, strict=True):
        assert our == theirs, said


def test_a_full_report_has_the_same_fields_in_the_same_order(real: Real, ours: Ours) -> None:
    for end in (real, ours):
        asked_anew(end)
    assert _fields(ours.say(FULL)[-1]) == _fields(real.say(FULL)[-1])


def test_status_report_has_the_same_fields_after_a_full_report(real: Real, ours: Ours) -> None:
    told = []
    for end in (real, ours):
        asked_anew(end)
        end.say(FULL)
        end.say(STATUS)
        told.append(_fields(end.say(STATUS)[-1]))
    assert told[0] == told[1]


def test_simulator_identifies_itself_like_the_firmware(real: Real, ours: Ours) -> None:
    """The signals of its board, its axes, its buffer; versions and stores are nobody's business."""
    told = [
        {line.partition(":")[0]: line for line in end.say(b"$I\n") if line.startswith("[")}
        for end in (real, ours)
    ]
    for key in ("[SIGNALS", "[AXS", "[AUX IO"):
        assert told[0].get(key) == told[1].get(key)
    blocks, buffer = (each["[OPT"].split(",")[1:3] for each in told)
    assert blocks == buffer


def _plain(lines: list[str]) -> list[str]:
    """Without messages, and of ``$G`` only the modes: tool, feed and speed words differ by build."""
    kept = [line for line in lines if not line.startswith("[MSG")]
    modes = r"G(?:[0-3]|7|8|17|18|20|21|90|91|94|95|96|97|54)\b|M[345789]\b"
    return [" ".join(re.findall(modes, line)) if line.startswith("[GC:") else line for line in kept]


def _fields(report: str) -> list[str]:
    return [field.partition(":")[0] for field in report.strip("<>").split("|")]
