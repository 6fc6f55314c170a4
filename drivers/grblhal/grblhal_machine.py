"""Machine run by a grblHAL controller, with its connection and the ports for the executor."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.faults import DriverHostTrip
from core.message import Message
from core.ports import ALL_UNKNOWN_PARTS, PROBE_INPUT, Clock, DriverError, MachinePorts, StopMode, UnknownPart
from drivers.grblhal import grblhal_scripts
from drivers.grblhal.grblhal_axes import GrblAxes
from drivers.grblhal.grblhal_blocks import GrblBlocks
from drivers.grblhal.grblhal_config import ESTOP, HARDWARE, GrblConfig
from drivers.grblhal.grblhal_controller import GrblController
from drivers.grblhal.grblhal_spindle import GrblEncoder, GrblSpindle
from drivers.grblhal.grblhal_terminals import ACCESSORY_LETTERS, GrblInputs, GrblIO, GrblProbe
from drivers.grblhal.grblhal_transport import GrblTransport, open_transport
from drivers.operator_station import OnScreenStation
from drivers.wakeups import ConnectionAttempt

_CYCLE_S = 0.005  # Seconds between two cycles during the connection.
_CONNECT_TIMEOUT_S = 15.0
_CLOSE_TIMEOUT_S = 4.0


class GrblMachine:
    """Connected and verified grblHAL controller with its ports.

    The constructor raises DriverError if the controller does not respond or is not suitable. ``transport``
    and ``advance_time`` are for tests, in which the clock advances only when the driver advances it.
    """

    def __init__(
        self,
        config: GrblConfig,
        clock: Clock,
        transport: GrblTransport | None = None,
        advance_time: Callable[[], None] = lambda: None,
    ) -> None:
        self._clock = clock
        self._idle = advance_time
        self._wire = transport
        self._trips = 0
        self.controller = GrblController(
            config, transport or open_transport(config.grblhal_table.port, config.grblhal_table.baud), clock
        )
        self.block_controller = GrblBlocks(self.controller)
        self.spindle = GrblSpindle(self.controller, self.block_controller)
        self.encoder = GrblEncoder(self.controller)
        self.controller_inputs = GrblInputs(self.controller, self.block_controller)
        self.io = GrblIO(self.controller, self.block_controller, self.controller_inputs)
        self.axes = GrblAxes(self.controller, self.block_controller, self.run_cycle, self._reopen)
        self.block_controller.list_terminals = self.io.list_usable_terminals
        self.touch_input = (
            GrblProbe(self.controller, self.axes, self.controller_inputs)
            if PROBE_INPUT in config.inputs
            else None
        )
        voided = self.controller.on_discard

        def handle_discard() -> None:
            voided()
            self.spindle.handle_reset()
            self.io.handle_reset()

        self.controller.on_discard = handle_discard
        self._connect()
        self.on_screen_station = OnScreenStation(clock, self.controller_inputs.read_input_states)
        self.ports = MachinePorts(
            clock=clock,
            axes=self.axes,
            spindle=self.spindle,
            io=self.io,
            station=self.on_screen_station,
            warnings=self._warnings(),
            blocks=self.block_controller,
            halt_machine=self.controller.halt_motion,
            touch=self.touch_input,
            unknown=self.find_unknown_parts,
            trip_monitor=self,
        )

    def run_cycle(self) -> None:
        """Run one cycle of the controller, blocks, spindle and terminals, without waiting."""
        self.controller.run_cycle()
        self.block_controller.send_pending_commands()
        self.spindle.send_spindle_commands()
        self.io.send_output_changes()
        self.controller_inputs.request_next_input()
        if self.touch_input is not None:
            self.touch_input.check_touch()

    def find_unknown_parts(self) -> frozenset[UnknownPart]:
        """Return the parts of the machine whose state is unknown.

        While the controller is silent, all states are unknown, because it may continue its blocks and its
        spindle may turn.
        """
        return ALL_UNKNOWN_PARTS if self.controller.is_silent else frozenset()

    def get_active_trip(self) -> DriverHostTrip | None:
        """Return the spindle and outputs that were still on after the controller was silent.

        Return None if nothing was on. The driver has switched them off since then.
        """
        found = self.controller.active_at_silence
        if found is None:
            return None
        unheard, letters = found
        outputs = self.controller.config.outputs
        on = (
            name for name, output in outputs.items() if ACCESSORY_LETTERS.get(output.terminal, " ") in letters
        )
        return DriverHostTrip(
            self._trips, unheard, bool({"S", "C"} & set(letters)), tuple(on), was_connection_lost=True
        )

    def acknowledge_trip(self, trip: DriverHostTrip) -> None:
        """Clear a trip after the control has handled it."""
        if trip.trip_number == self._trips:
            self._trips, self.controller.active_at_silence = self._trips + 1, None

    def _reopen(self) -> ConnectionAttempt[GrblTransport]:
        """Close the old connection, which releases the port, and begin to reopen the connection."""
        close, config = self.controller.close, self.controller.config

        def reopen_transport() -> GrblTransport:
            close()
            return self._wire or open_transport(config.grblhal_table.port, config.grblhal_table.baud)

        return ConnectionAttempt(reopen_transport, synchronous=self._wire is not None)

    def close(self) -> None:
        """Stop all motion and then close the connection."""
        self.axes.stop(StopMode.RAMP_OFF)
        self._rounds(_CLOSE_TIMEOUT_S)
        self.controller.close()

    def _connect(self) -> None:
        c = self.controller
        c.start_script(grblhal_scripts.connect_controller(c))
        self._rounds(_CONNECT_TIMEOUT_S)
        if c.is_script_running or c.identity is None or (c.fault and c.alarm_number == 0):
            c.close()
            raise DriverError(f"{c.config.grblhal_table.port}: {c.fault or 'no response from controller'}")

    def _rounds(self, limit: float) -> None:
        end = self._clock.now() + limit
        while self.controller.is_script_running and not self.controller.is_lost and self._clock.now() < end:
            self._idle()
            self.run_cycle()
            self._clock.sleep_until(self._clock.now() + _CYCLE_S)

    def _list_differences(self) -> list[str]:
        """Return a warning for each controller setting that differs from the machine file."""
        c = self.controller
        warnings: list[str] = []
        for axis in c.wired_axes:
            speed, accel = c.get_max_axis_speed(axis.name), c.read_axis_setting(120, axis.name)
            if speed and not 0.99 * axis.max_velocity <= speed <= 1.01 * axis.max_velocity:
                warnings.append(
                    Message(
                        "{axis}: the controller allows {speed} mm/min, but the machine file specifies {vmax} "
                        "mm/min",
                        axis=axis.name,
                        speed=f"{60 * speed:.0f}",
                        vmax=f"{60 * axis.max_velocity:.0f}",
                    )
                )
            if 0.0 < accel < 0.99 * axis.max_acceleration:
                warnings.append(
                    Message(
                        "{axis}: the controller decelerates at {accel} mm/s² instead of {amax} mm/s²",
                        axis=axis.name,
                        accel=f"{accel:.0f}",
                        amax=f"{axis.max_acceleration:.0f}",
                    )
                )
        if c.config.has_own_spindle and 0.0 < self.spindle.controller_max_rpm < c.config.max_rpm:
            warnings.append(
                Message(
                    "spindle: $30 allows {highest} rpm, but the machine file specifies {rpm_max} rpm",
                    highest=f"{self.spindle.controller_max_rpm:g}",
                    rpm_max=f"{c.config.max_rpm:g}",
                )
            )
        return warnings

    def _list_homing_warnings(self) -> list[str]:
        """Return a warning if axes need a home switch, but homing is disabled in the controller."""
        if self.controller.homing_setting_bits:
            return []
        names = [
            axis.name
            for axis in self.controller.wired_axes
            if not axis.has_absolute_encoder and axis.home_position_mm is None
        ]
        if not names:
            return []
        return [
            Message(
                "{names}: homing is disabled in the controller ($22=0). If the axis has "
                "switches, set $22 to 3; otherwise add method = 37 to home = {{ … }} of the "
                "axis, so that Home uses the current position",
                names=" and ".join(names),
            )
        ]

    def _warnings(self) -> list[str]:
        config = self.controller.config
        outputs = {
            f"{name} ({each.terminal})": self.io.describe_missing_output(name)
            for name, each in config.outputs.items()
        }
        warnings = _group_texts(outputs, "output {names}: {reason}", "outputs {names}: {reason}")
        inputs = {
            f"{name} ({config.inputs[name].terminal})": why
            for name, why in self.controller_inputs.list_missing_inputs().items()
        }
        warnings += _group_texts(inputs, "input {names}: {reason}", "inputs {names}: {reason}")
        warnings += self._list_differences() + self._list_homing_warnings()
        estop = self.controller.config.inputs.get(ESTOP)
        if estop is not None and estop.terminal == HARDWARE:
            warnings.append(
                "the E-stop acts only on the hardware: the controller does not detect it, and the "
                "screen does not show its state"
            )
        if "thread" not in self.block_controller.capabilities:
            warnings.append("the controller does not report a spindle encoder, so threading is rejected")
        return warnings


def _group_texts(items: Mapping[str, str], one: str, several: str) -> list[str]:
    """Return one sentence for each different reason, with the names to which it applies.

    A name without a reason is omitted.
    """
    reasons: dict[str, list[str]] = {}
    for name, reason in items.items():
        if reason:
            reasons.setdefault(reason, []).append(name)
    return [
        Message(one if len(names) == 1 else several, names=", ".join(names), reason=reason)
        for reason, names in reasons.items()
    ]
