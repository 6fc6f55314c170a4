"""What the end of a program leaves of the modal state, for the program that comes next and for MDI."""

from __future__ import annotations

from core.interpreter.modal import Modal


def after_end(old: Modal, rpm: float, *, reset: bool) -> Modal:
    """The state of power-up, but for units, the tool's frame and, without ``reset``, the M functions.

    ``rpm`` (unsigned) is the commanded speed at the end. M30 resets the M functions, M02 does not.
    """
    return Modal(
        metric=old.metric,
        rapid_rate=old.rapid_rate,
        tool=old.tool,
        tool_x=0.0 if old.settable else old.tool_x,
        tool_z=0.0 if old.settable else old.tool_z,
        preset_x=old.preset_x,
        preset_z=old.preset_z,
        collet_closed=old.collet_closed,
        spindle=0 if reset else old.spindle,
        rpm=rpm if old.spindle and not reset else old.rpm,
        coolant=old.coolant and not reset,
        outputs=frozenset() if reset else old.outputs,
        comment=old.comment,
        offset_c=old.offset_c if old.offset_c % 360.0 == 0.0 else 0.0,  # whole turns stay, offsets go
        wraps_c=old.wraps_c,
    )
