"""The hands at a station that lives in the feeder: the simulated one, or the one on the screen."""

from __future__ import annotations

from drivers.feeder.client import Line
from drivers.feeder.wire import NOTHING, Message


class FeederHands:
    """Any thread may act; it goes out with the executor's next look, and nobody waits."""

    def __init__(self, line: Line) -> None:
        self._line = line

    def press_left(self) -> None:
        """Left palm button down."""
        self._do("press_left")

    def release_left(self) -> None:
        """Left palm button up."""
        self._do("release_left")

    def press_right(self) -> None:
        """Right palm button down."""
        self._do("press_right")

    def release_right(self) -> None:
        """Right palm button up."""
        self._do("release_right")

    def press_hold(self) -> None:
        """Feed hold button down."""
        self._do("press_hold")

    def release_hold(self) -> None:
        """Feed hold button up."""
        self._do("release_hold")

    def press_estop(self) -> None:
        """Hit the E-stop."""
        self._do("press_estop")

    def release_estop(self) -> None:
        """Twist it free."""
        self._do("release_estop")

    def set_spindle_auto(self, auto: bool) -> None:
        """Spindle AUTO/OFF."""
        self._do("set_spindle_auto", auto)

    def set_spindle_pot(self, fraction: float) -> None:
        """Spindle override, 0…1."""
        self._do("set_spindle_pot", fraction)

    def set_feed_pot(self, fraction: float) -> None:
        """Feed override, 0…1.5."""
        self._do("set_feed_pot", fraction)

    def turn_handwheel(self, counts: int) -> None:
        """Turn the handwheel on by so many counts, signed."""
        self._do("turn_handwheel", counts)

    def set_input(self, name: str, on: bool) -> None:
        """Make an input of a simulated machine true or false, at once. Raises DriverError."""
        self._line.ask(_act("set_input", name, on))

    def break_something(self, what: str, *values: object) -> None:
        """A fault of the simulated machine, by the name of its method."""
        self._do(what, *values)

    def _do(self, name: str, *values: object) -> None:
        self._line.post(_act(name, *values))


def _act(name: str, *values: object) -> Message:
    return Message({"do": "hand", "name": name, "values": list(values)}, NOTHING)
