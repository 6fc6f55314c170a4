"""Key actions of the main window that control the machine or answer a question."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.desk.desk import Desk
from app.screen.window.key_table import NO_KEY, YES_KEY


def make_key_actions(desk: Desk) -> dict[str, Callable[[], None]]:
    """Return the actions of the keys by key name."""
    return {
        "S": partial(desk.toggle_switch, "single_block"),
        "O": partial(desk.toggle_switch, "optional_stop"),
        "C": partial(desk.toggle_switch, "cycle_repeat"),
        "P": partial(desk.toggle_switch, "no_count"),
        "/": desk.program_choice.toggle_block_delete,
        "H": desk.start_feed_hold,
        "R": desk.reset_control,
        "D": desk.enable_drives,
        "E": desk.station_keys.press_estop,
        "U": desk.station_keys.release_estop,
        YES_KEY: desk.confirm_question_if_unchanged,
        NO_KEY: desk.reject_question,
        "A": desk.station_keys.toggle_spindle_switch,
        ",": partial(desk.station_controls.turn_spindle_pot, -1),
        ".": partial(desk.station_controls.turn_spindle_pot, 1),
        "+": partial(desk.station_keys.step_feed_override, 1),
        "-": partial(desk.station_keys.step_feed_override, -1),
        "Y": desk.confirm_question,
    }
