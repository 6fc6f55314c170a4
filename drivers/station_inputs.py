"""The operator station of a machine whose buttons are inputs by the names of the machine file."""

from __future__ import annotations

from collections.abc import Mapping

from core.ports import StationState


def station_of(
    inputs: Mapping[str, bool],
    *,
    pot_switch: str,
    spindle_pot: float,
    feed_pot: float,
    handwheel: int,
    age: float,
    spindle_load: float | None,
) -> StationState:
    """What the station tells. A button that the machine file does not have is never pressed.

    ``pot_switch`` is the input that the machine file names beside the spindle's pot, empty where it names
    none. Without an input ``spindle_auto`` that one says whether the spindle is on AUTO.
    """
    auto = inputs.get(pot_switch, True) if pot_switch else True
    return StationState(
        estop=inputs.get("estop", False),
        start=inputs.get("start", False),
        hold=inputs.get("hold", False),
        spindle_auto=inputs.get("spindle_auto", auto),
        spindle_pot=spindle_pot,
        feed_pot=feed_pot,
        handwheel=handwheel,
        age=age,
        spindle_load=spindle_load,
    )
