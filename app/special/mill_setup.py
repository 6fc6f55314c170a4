"""The setup sheet of a mill: blank, preset, names, lengths and radii in place of bar, chuck and nose."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from app.desk.readouts import rotary_angle
from app.desk.translation import tr
from core.geometry.rotary_axes import DatumPreset
from core.interpreter.shared.job_setup import MillTool, Setup, ToolOffset
from core.interpreter.shared.working_plane import Corners
from core.message import Message

Length = Callable[[float], str]


@dataclass(frozen=True, slots=True)
class MillSetup:
    """``blank``: corners of BLK FORM, mm. ``names`` and ``tools`` are those of the tool table."""

    blank: Corners | None
    preset: int
    datum: DatumPreset | None  # the row of the preset; None of 0, which is the machine file's
    names: Mapping[int, str]
    tools: Mapping[int, MillTool]

    def stock_words(self, length: Length) -> str:
        """Length, width and height of the blank."""
        if self.blank is None:
            return tr("stock not specified because the program has no BLK FORM")
        low, high = self.blank
        return Message("BLK FORM  {b}", b=" × ".join((length(b - a) for a, b in zip(low, high, strict=True))))

    def preset_words(self, length: Length) -> str:
        """Which preset is in force, and where it lies, from home."""
        if self.datum is None:
            return f"{self.preset}   {tr('zero point from the machine file')}"
        places = (f"{name} {length(at)}" for name, at in zip("XYZ", self.datum.origin, strict=True))
        turned = (f"{name} {rotary_angle(at)}°" for name, at in self.datum.zeros if at)
        rotation = (
            (Message("ROT {rotation}°", rotation=rotary_angle(self.datum.rotation)),)
            if self.datum.rotation
            else ()
        )
        return f"{self.preset}   " + "   ".join((*places, *turned, *rotation))

    def tool_words(self, number: int) -> str:
        """Its name, point angle and teeth in the tool table."""
        row = self.tools.get(number, MillTool())
        words = (
            self.names.get(number, ""),
            f"{tr('POINT ANGLE')} {row.point:g}°" if row.point else "",
            f"{row.teeth} {tr('teeth')}" if row.teeth else "",
        )
        return ", ".join(filter(None, words)) or tr("no tool name in the tool table")


def mill_setup(setup: Setup, blank: Corners | None) -> MillSetup | None:
    """Of a job on a mill; None on a lathe."""
    if setup.kinematics is None:
        return None
    datum = setup.presets.get(setup.preset) if setup.preset else None
    names = {number: name for name, number in setup.tool_names.items()}
    return MillSetup(blank, setup.preset, datum, names, setup.mill_tools)


def offset_words(offset: ToolOffset, length: Length) -> str:
    """L and R as they count: with DL and DR."""
    return f"L {length(offset.z)}   R {length(offset.nose_radius)}"
