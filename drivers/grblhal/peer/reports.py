"""The look-alike's status reports, with what each carries and what it leaves out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drivers.grblhal.peer.firmware import Firmware

_OFFSETS_BUSY, _OFFSETS_IDLE = 30, 10  # every so many reports
_OVERRIDES_BUSY, _OVERRIDES_IDLE = 20, 10
_BUSY = frozenset(("Run", "Hold", "Jog", "Home", "Door"))


@dataclass(slots=True)
class Reports:
    """Offsets and overrides come every so often, and when they have changed.

    A report with offsets has no overrides: so a full one, which always has offsets, never tells them.
    """

    offsets_in: int = 0
    overrides_in: int = 0
    offsets_due: bool = False
    overrides_due: bool = False

    def text(self, m: Firmware, *, full: bool) -> str:
        """One report, without its end of line."""
        busy = m.state.partition(":")[0] in _BUSY
        offsets, overrides = self._due(full, busy)
        return f"<{m.told_state(full)}{_motion(m)}{_extras(m, offsets, overrides, full)}>"

    def _due(self, full: bool, busy: bool) -> tuple[bool, bool]:
        offsets = full or self.offsets_due
        if self.offsets_in > 0 and not offsets:
            self.offsets_in -= 1
        else:
            self.offsets_in = (_OFFSETS_BUSY if busy else _OFFSETS_IDLE) - 1
        overrides = False
        if self.overrides_in > 0 and not (full or self.overrides_due):
            self.overrides_in -= 1
        elif not offsets:
            overrides = True
            self.overrides_in = (_OVERRIDES_BUSY if busy else _OVERRIDES_IDLE) - 1
        self.overrides_due = False
        self.offsets_due = self.offsets_in == 0
        return offsets, overrides


def _stepped(place: float, steps: float) -> float:
    """It counts whole steps."""
    return round(place * steps) / steps


def _motion(m: Firmware) -> str:
    scale = 2.0 if m.program.modes.radius == "G7" else 1.0
    x, z = (
        _stepped(place, m.registers[number]) for place, number in zip(m.slides.place, (100, 102), strict=True)
    )
    text = f"|MPos:{x * scale:.3f},0.000,{z:.3f}|Bf:{m.slides.free},{m.rx_free}"
    if m.slides.queue and m.slides.queue[0].number:
        text += f"|Ln:{m.slides.queue[0].number}"
    text += f"|FS:{60.0 * m.slides.v:.0f},{abs(m.commanded):.0f}"
    if m.quirks.encoder:
        text += f",{abs(m.spindle.speed):.0f}"
    return text + (f"|Pn:{m.pins}" if m.pins else "")


def _extras(m: Firmware, offsets: bool, overrides: bool, full: bool) -> str:
    text = "|WCO:" + ",".join(f"{value:.3f}" for value in m.program.offset) if offsets else ""
    text += "|WCS:G54" if full else ""
    text += f"|Ov:{m.feed_percent},{m.rapid_percent},{m.spindle_percent}" if overrides else ""
    accessories = "" if not m.commanded else "S" if m.commanded > 0.0 else "C"
    accessories += "F" * m.outputs.get("flood", False) + "M" * m.outputs.get("mist", False)
    text += f"|A:{accessories}" if full or (overrides and accessories) else ""
    if not full:
        return text
    homed = f"|H:{int(m.homed & 5 == 5)}" + (f",{m.homed}" if int(m.registers[22]) & 2 else "")
    read = "" if m.read is None else f"|In:{m.read}"
    lathe = f"|D:{int(m.program.modes.radius == 'G7')}" if m.registers.lathe else ""
    return f"{text}|Sc:{homed}{lathe}|T:0|TLR:0{read}|FW:grblHAL"
