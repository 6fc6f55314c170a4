"""The pins of the outputs and of the safety chain in HAL."""

from __future__ import annotations

from drivers.hal.bridge.packets import BridgeConfig, PacketHead
from drivers.hal.bridge.row_streams import HalPins
from drivers.process_messages import text
from drivers.setpoint_pieces import INFINITY

_WATCHDOG_RESTART_S = 0.006  # Seconds for which the watchdog is off to restart it.
_RESET_PULSE_S = 0.05  # Duration of the reset pulse in s.


class OutputPins:
    """HAL pins of the machine's outputs."""

    def __init__(self, config: BridgeConfig, pins: HalPins) -> None:
        self._config, self._pins = config, pins

    def set_output(self, head: PacketHead) -> None:
        """Set one output to the state that a packet from the driver contains."""
        name, on = text(head, "name"), head.get("on") is True
        if name in self._config.outputs:
            self._pins[f"out.{name}"] = on

    def set_safe_states(self) -> None:
        """Set all outputs to their safe states; outputs without a safe state do not change."""
        for name, safe in self._config.outputs.items():
            if safe is not None:
                self._pins[f"out.{name}"] = safe

    def switch_outputs_off(self) -> None:
        """Set the outputs to their safe states, except the lamps."""
        for name, safe in self._config.outputs.items():
            if safe is not None and name not in self._config.lamps:
                self._pins[f"out.{name}"] = safe


class SafetyChainPins:
    """The pins that restart the watchdog and reset the safety chain."""

    def __init__(self, pins: HalPins) -> None:
        self._pins = pins
        self._reset_until = self._watch_from = -INFINITY

    def close_chain(self, now: float) -> None:
        """Close the E-stop chain: restart the watchdog and start the reset pulse, if this is necessary."""
        if not self._pins["alive"]:
            self._watch_from = now + _WATCHDOG_RESTART_S
        if not self._pins["chain-ok"]:
            self._reset_until = now + _RESET_PULSE_S

    def update_pulses(self, now: float) -> None:
        """End the watchdog restart and the reset pulse when they are due."""
        self._pins["watch"] = now >= self._watch_from
        self._pins["reset"] = now < self._reset_until and bool(self._pins["alive"])
