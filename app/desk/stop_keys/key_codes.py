"""X key codes of the stop keys and of the letters on a PC keyboard, independent of the keyboard layout."""

from __future__ import annotations

from app.desk.stop_keys.stop_records import StopKind

STOP_KEY_CODES = {127: StopKind.HOLD, 78: StopKind.ESTOP}
"""X key codes of Pause and Scroll Lock, with the stop that each key triggers."""
LETTERS_BY_CODE = dict(
    zip((*range(24, 34), *range(38, 47), *range(52, 59)), "QWERTYUIOPASDFGHJKLZXCVBNM", strict=True)
)
"""Letters of the US layout by X key code, for layouts without Latin letters."""
STOP_CHARACTERS = {"H": StopKind.HOLD, " ": StopKind.HOLD, "E": StopKind.ESTOP}
"""Characters that stop the machine while no text field has the keyboard focus."""
