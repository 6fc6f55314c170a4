"""The hands at a station that lives in the feeder: the simulated one, or the one on the screen."""

from __future__ import annotations

from collections.abc import Callable

from drivers.feeder.feeder_line import Line
from drivers.feeder.feeder_messages import NOTHING, Message


def _hand(name: str) -> Callable[..., None]:
    """The method of this name at that station: it goes out with the executor's next look, nobody waits."""

    def use(self: FeederHands, *values: object) -> None:
        self.post(name, *values)

    return use


class FeederHands:
    """Any thread may act; what an act means stands at ``app.desk.station_hands.StationPanel``."""

    def __init__(self, line: Line) -> None:
        self._line = line

    press_left, release_left = _hand("press_left"), _hand("release_left")
    press_right, release_right = _hand("press_right"), _hand("release_right")
    press_hold, release_hold = _hand("press_hold"), _hand("release_hold")
    press_estop, release_estop = _hand("press_estop"), _hand("release_estop")
    set_spindle_auto, set_spindle_pot = _hand("set_spindle_auto"), _hand("set_spindle_pot")
    set_feed_pot, turn_handwheel = _hand("set_feed_pot"), _hand("turn_handwheel")

    def set_input(self, name: str, on: bool) -> None:
        """Make an input of a simulated machine true or false, at once. Raises DriverError."""
        self._line.ask(_act("set_input", name, on))

    def post(self, name: str, *values: object) -> None:
        """Use the method of this name at the station."""
        self._line.post(_act(name, *values))


def _act(name: str, *values: object) -> Message:
    return Message({"do": "hand", "name": name, "values": list(values)}, NOTHING)
