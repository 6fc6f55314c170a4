"""The spindle's pins in HAL: speed, position mode for the C axis, and orientation to an angle."""

from __future__ import annotations

from drivers.hal.bridge.packets import BridgeConfig, PacketHead, number
from drivers.hal.bridge.row_streams import HalPins
from drivers.setpoint_pieces import INFINITY

_ORIENT_OFF_S = 0.005  # Seconds for which the orient pin is off before a new angle.


class SpindlePins:
    """HAL pins of the spindle.

    ``c_position`` is the position of the C axis in HAL's count when it was engaged.
    """

    def __init__(self, config: BridgeConfig, pins: HalPins) -> None:
        self._config, self._pins = config, pins
        self.c_position: float | None = None
        self._c_from = INFINITY  # Time when the drive changes to position mode.
        self._orient_from = INFINITY  # Time when the orientation starts.

    @property
    def is_orienting(self) -> bool:
        """Return whether the drive orients the spindle to an angle."""
        return "orient" in self._config.spindle and bool(self._pins["spindle.orient"])

    @property
    def held_c_position(self) -> float | None:
        """Return the position of C once the drive has changed to position mode, otherwise None."""
        return self.c_position if self._c_from == INFINITY else None

    def apply_due_actions(self, now: float) -> None:
        """Change to position mode, and orient the spindle, as soon as each action is due."""
        if self._c_from <= now:
            self._c_from = INFINITY
            self._pins["spindle.position_mode"] = 1
        if self._orient_from <= now:
            self._orient_from = INFINITY
            self._pins["spindle.orient"] = 1

    def set_speed(self, head: PacketHead) -> None:
        """Set the commanded speed; the spindle does not turn while the E-stop chain is open."""
        rpm, on = number(head, "rpm"), head.get("on") is True
        if on and not self._pins["chain-ok"]:
            return
        said = {"speed": rpm, "on": on, "forward": on and rpm >= 0.0, "reverse": on and rpm < 0.0}
        if on:
            self.release_c()
        self._release_angle()
        for name, value in said.items():
            if name in self._config.spindle:
                self._pins[f"spindle.{name}"] = value

    def request_position_mode(self, time_s: float) -> None:
        """Request that the drive changes to position mode at time ``time_s``."""
        self._c_from = time_s

    def release_c(self) -> None:
        """Release C by switching the drive back from position mode."""
        self.c_position, self._c_from = None, INFINITY
        if "position_mode" in self._config.spindle:
            self._pins["spindle.position_mode"] = 0

    def orient_spindle(self, head: PacketHead, now: float) -> None:
        """Orient the spindle to the angle in a packet.

        The orient pin is turned off and then on, because its rising edge latches the angle.
        """
        self._release_angle()
        if head.get("on") is not True or not self._pins["chain-ok"]:
            return
        self._pins["spindle.orient_angle"] = number(head, "angle")
        self._pins["spindle.orient_mode"] = int(number(head, "mode"))
        self._orient_from = now + _ORIENT_OFF_S

    def _release_angle(self) -> None:
        self._orient_from = INFINITY
        if "orient" in self._config.spindle:
            self._pins["spindle.orient"] = 0

    def switch_spindle_off(self) -> None:
        """Switch the spindle off, and end position mode and orientation."""
        self.release_c()
        self._release_angle()
        for name in self._config.spindle:
            self._pins[f"spindle.{name}"] = 0
