"""Settings of a controller: the required values and their comparison with the reported values."""

from __future__ import annotations

import math
from collections.abc import Mapping

from drivers.grblhal.grblhal_controller import GrblController

# Machine position, buffers, line numbers, speeds, pins, offsets, overrides; the number of an alarm.
_REPORTS = 0x7F | 0x400
_PARSER = 0x200  # Unrequested parser state, which would look like a reply to $G.
_RESTORE = 0x2  # Feed hold option: the spindle restarts automatically.
_MASK, _MODE, _LATHE, _AFTER_HOLD = 10, 32, 2, 63


def find_required_settings(c: GrblController, there: Mapping[int, str]) -> dict[int, float | str]:
    """Return the settings that TurnDesk requires from a controller.

    ``there`` contains the settings that the controller reports now.
    """
    wanted: dict[int, float | str] = dict(c.config.grblhal_table.settings)
    always = c.identity is not None and c.identity.is_in_lathe_mode and _MODE not in there
    if always and wanted.get(_MODE) == _LATHE:
        del wanted[_MODE]  # Firmware built for lathes only does not have this setting.
    wanted[_MASK] = (int(float(there.get(_MASK, "0"))) | _REPORTS) & ~_PARSER
    if _AFTER_HOLD in there:
        wanted[_AFTER_HOLD] = int(float(there[_AFTER_HOLD])) & ~_RESTORE
    return wanted


def parse_settings(lines: list[str]) -> dict[int, str]:
    """Return the settings in the lines that the controller sent."""
    pairs = (line[1:].split("=", 1) for line in lines if line.startswith("$") and "=" in line)
    return {int(n): value for n, value in pairs}


def is_same_setting(present_value: str | None, required_value: float | str) -> bool:
    """Return whether a setting equals the required value, rounded to the decimals of the report."""
    if present_value is None or isinstance(required_value, str):
        return present_value == required_value
    decimals = len(present_value.partition(".")[2])
    try:
        return math.isclose(
            float(present_value), required_value, rel_tol=1e-6, abs_tol=0.5001 * 10.0**-decimals
        )
    except ValueError:
        return False


def format_setting(value: float | str) -> str:
    """Return a setting value as text without an exponent, because the controller cannot read exponents."""
    if isinstance(value, str):
        return value
    return f"{value:.6f}".rstrip("0").rstrip(".")
