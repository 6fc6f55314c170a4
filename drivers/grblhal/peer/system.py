"""The look-alike's ``$`` lines: identity, settings, unlocking, homing, the parser's state."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drivers.grblhal.peer.firmware import Firmware

_AXES = {"": 7, "X": 1, "Y": 2, "Z": 4}
_BLOCKING = frozenset(("$X", "$J", "$H", "$HX", "$HY", "$HZ"))  # refused behind a critical alarm


def identity(m: Firmware) -> list[str]:
    """What ``$I`` tells; auxiliary ports only where there are any."""
    quirks = m.quirks
    lathe = "LATHE," if m.registers.lathe else ""
    home = "HOME," if int(m.registers[22]) & 1 else ""
    ports = [f"[AUX IO:{quirks.inputs},{quirks.outputs},0,0]"] if quirks.inputs + quirks.outputs else []
    return [
        "[VER:1.1f.20260817:]",
        "[OPT:VNML+,100,1024,3,16]",
        "[AXS:3:XYZ]",
        f"[NEWOPT:ENUMS,RT+,{home}{lathe}EXPR,TC,SED]",
        "[FIRMWARE:grblHAL]",
        "[NVS STORAGE:EEPROM]",
        "[DRIVER:Simulator]",
        "[DRIVER VERSION:260913]",
        *ports,
    ]


def answer(m: Firmware, line: str) -> int | None:
    """Carry a line out: its error, 0 for none; None where the answer comes later."""
    command = line.partition("=")[0]
    if m.blocking and (command in _BLOCKING):
        return 79
    if command.startswith("$H"):
        return _home(m, command.removeprefix("$H"))
    if command == "$X":
        return _unlock(m)
    told = _told(m, line)
    if told:
        m.say("".join(f"{text}\r\n" for text in told))
        return 0
    found = re.fullmatch(r"\$(\d+)=(.*)", line)
    if found is None:
        return 3
    idle = m.state == "Idle" or m.alarm
    return m.registers.store(int(found[1]), found[2]) if idle else 8


def _told(m: Firmware, line: str) -> list[str]:
    if line == "$I":
        return identity(m)
    if line == "$$":
        return m.registers.told()
    return [m.program.told()] if line == "$G" else []


def _unlock(m: Firmware) -> int:
    if not m.alarm:
        return 0
    if "E" in m.pins:
        return 50
    if int(m.registers[22]) & 5 == 5 and m.homed & 5 != 5:
        return 46
    m.alarm = 0
    m.say("[MSG:Caution: Unlocked]\r\n")
    return 0


def _home(m: Firmware, letter: str) -> int | None:
    flags = int(m.registers[22])
    if letter not in _AXES:
        return 3
    if not flags & 1 or (letter and not flags & 2):
        return 5
    m.begin_homing(_AXES[letter])
    return None
