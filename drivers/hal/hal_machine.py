"""Machine on HAL; its cycle is the only loop that uses the HAL bridge.

Inputs, outputs, pots and the operator station are HAL pins with the names of the machine file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.ports import (
    ALL_UNKNOWN_PARTS,
    Clock,
    DriverError,
    FloatArray,
    MachinePorts,
    StationState,
    UnknownPart,
)
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_link import HalLink
from drivers.hal.hal_session import BridgeLink, create_bridge_config
from drivers.hal.hal_spindle import HalOrientingSpindle, HalSpindle, HalSpindleCAxis
from drivers.operator_station import build_station_state
from drivers.port_checks import LOG_ROWS, SampleRingBuffer, find_output, require_output_allowed


class HalTerminals:
    """Inputs, outputs and operator station on HAL pins (``core.ports.DigitalIO`` and ``Station``)."""

    def __init__(self, config: HalConfig, link: HalLink, now: Callable[[], float]) -> None:
        self._config = config
        self._link = link
        self._now = now
        self._written: dict[str, tuple[bool, int]] = {}  # Commands that the bridge has not executed yet.

    def inputs(self) -> Mapping[str, bool]:
        """Return all inputs by name, with True for an active input."""
        reported_states = self._link.last_report.get("in")
        raw = reported_states if isinstance(reported_states, list) else [False] * len(self._config.inputs)
        wired = zip(self._config.inputs.items(), raw, strict=True)
        return {name: on is not each.is_active_low for (name, each), on in wired}

    def get_outputs(self) -> Mapping[str, bool]:
        """Return all outputs by name with the states of their HAL pins."""
        reported_states = self._link.last_report.get("is")
        real = reported_states if isinstance(reported_states, list) else [False] * len(self._config.outputs)
        found = {name: on is True for name, on in zip(self._config.outputs, real, strict=True)}
        for name, (on, order) in list(self._written.items()):
            if self._link.is_command_executed(order):
                del self._written[name]
            else:
                found[name] = on
        return found

    def write(self, name: str, is_on: bool) -> None:
        """Switch one output.

        Raises DriverError in these cases:

        - The machine file does not define the output.
        - The output is to be switched on while the bridge is silent, or the bridge has ended.
        - The E-stop chain is open, and the new state is not the safe state. A lamp may still be switched, as
          may an output without a safe state.
        """
        output = find_output(name, self._config.outputs)
        require_output_allowed(name, is_on, self._link.failure_reason)
        chained = output.safe_state is not None and not output.is_lamp
        if chained and is_on is not output.safe_state and self._link.last_report.get("ok") is not True:
            raise DriverError(
                "output {name} does not change because the E-stop chain is open; press Reset",
                "output",
                name=name,
            )
        self._say(name, is_on)

    def switch_to_safe_state(self) -> None:
        """Set every output to its safe state."""
        if self._link.failure:
            return
        order = self._link.send_command("safe")
        for name, output in self._config.outputs.items():
            if output.safe_state is not None:
                self._written[name] = output.safe_state, order

    def _say(self, name: str, on: bool) -> None:
        self._written[name] = on, self._link.send_command("out", name=name, on=on)

    def read_state(self) -> StationState:
        """Return the state of the operator station, with the age of its inputs."""
        return build_station_state(
            self.inputs(),
            self._config.pots,
            self._read_analog,
            handwheel=round(self._read_analog("handwheel")),
            age_s=self._link.input_age_s,
        )

    def _read_analog(self, name: str) -> float:
        """Return the value of an analog pin, where 1 is the end of a pot's range.

        The result is 0 if the pin is not connected.
        """
        values, names = self._link.last_report.get("analog"), list(self._config.pots)
        if not isinstance(values, list) or name not in names:
            return 0.0
        return float(values[names.index(name)])


class HalSampleSource:
    """Scope samples of HAL (``core.ports.SampleSource``), one for each period of the servo thread."""

    def __init__(self, axes: HalAxes, period: float) -> None:
        self.sample_rate_hz = 1.0 / period
        self._log = SampleRingBuffer(len(axes.axes))
        axes.set_sample_handler(self._log.append_row)

    def take_samples(self, max_rows: int = LOG_ROWS) -> FloatArray:
        """Return at most ``max_rows`` samples since the last call, oldest first."""
        return self._log.pop_rows(max_rows)


class HalMachine:
    """A machine on HAL, to which the constructor connects.

    The constructor raises DriverError if a pin does not match the machine file, and names the pin.
    """

    def __init__(
        self,
        config: HalConfig,
        clock: Clock,
        open_link: Callable[[], BridgeLink],
        idle: Callable[[], object] | None = None,
    ) -> None:
        self.config = config
        self.clock = clock
        self.bridge_link = HalLink(open_link, clock, create_bridge_config(config), idle)
        self.axes = HalAxes(config, self.bridge_link, clock.now)
        self.spindle = HalSpindle(config, self.bridge_link, self.axes)
        self.spindle_c = _create_spindle_c(config, self.axes, self.spindle, self.bridge_link)
        turned = config.spindle.is_driven_by_hal and bool(config.spindle.pins.orient)
        self.orientation = HalOrientingSpindle(self.axes, self.spindle, self.bridge_link) if turned else None
        self.axes.fault_clearers.append(self.spindle.spindle_index.clear_fault)
        self.axes.reconnect_handlers.append(self.spindle.spindle_index.discard_index)
        self.io = HalTerminals(config, self.bridge_link, clock.now)
        self.samples = HalSampleSource(self.axes, config.hal_table.period)
        try:
            self.bridge_link.connect()
        except DriverError:
            self.bridge_link.close()
            raise
        self.axes.handle_connection()

    @property
    def ports(self) -> MachinePorts:
        """Return the ports for the executor.

        The terminals are also the operator station.
        """
        follows = self.config.spindle.has_encoder and bool(self.config.spindle.pins.position)
        return MachinePorts(
            clock=self.clock,
            axes=self.axes,
            spindle=self.spindle,
            io=self.io,
            station=self.io,
            gear=self.axes if follows else None,
            lock=self.spindle_c,
            orientation=self.orientation,
            touch=self.axes.touch_input,
            samples=self.samples,
            unknown=self.find_unknown_parts,
            warnings=self.bridge_link.warnings,
        )

    def find_unknown_parts(self) -> frozenset[UnknownPart]:
        """Return the parts of the machine state that are unknown.

        All parts are unknown if the bridge, HAL or the board does not respond.
        """
        return ALL_UNKNOWN_PARTS if self.bridge_link.is_state_unknown else frozenset()

    def run_cycle(self) -> None:
        """Run one cycle: receive packets, monitor the machine and send a heartbeat.

        Call this method every few milliseconds.
        """
        self.bridge_link.process_packets()
        self.axes.run_cycle()
        self.spindle.update_spindle()
        if self.spindle_c is not None:
            self.spindle_c.continue_mode_change()
        if self.orientation is not None:
            self.orientation.update_orientation()
        self.bridge_link.send_heartbeat()

    def close(self) -> None:
        """Close the connection, after which the bridge brakes and switches off, and HAL is shut down."""
        self.bridge_link.close()


def _create_spindle_c(
    config: HalConfig, axes: HalAxes, spindle: HalSpindle, link: HalLink
) -> HalSpindleCAxis | None:
    """Create the C axis on the spindle drive, or return None if C is absent or has its own drive."""
    number = next((n for n, axis in enumerate(config.axes) if axis.is_spindle_c_axis), None)
    if number is None:
        return None
    mode_pin_path = "spindle.in_position_mode" if config.spindle.pins.in_position_mode else ""
    return HalSpindleCAxis(axes, spindle, link, number, mode_pin_path)
