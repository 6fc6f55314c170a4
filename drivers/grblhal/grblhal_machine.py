"""grblHAL controller as a machine: its connection and the ports for the executor."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.faults import Trip
from core.message import Message
from core.ports import ALL_UNKNOWN, PROBE, Clock, DriverError, MachinePorts, Stop, Unknown
from drivers.grblhal import grblhal_scripts
from drivers.grblhal.grblhal_axes import GrblAxes
from drivers.grblhal.grblhal_blocks import GrblBlocks
from drivers.grblhal.grblhal_config import ESTOP, HARDWARE, GrblConfig
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_spindle import GrblEncoder, GrblSpindle
from drivers.grblhal.grblhal_terminals import LETTERS, GrblInputs, GrblIO, GrblProbe
from drivers.grblhal.grblhal_wire import Wire, open_wire
from drivers.operator_station import PanelStation
from drivers.waiting import Opening

_ROUND = 0.005  # Seconds between two cycles during the connection.
_CONNECTING = 15.0
_LEAVING = 4.0


class GrblMachine:
    """Connected and verified controller with its ports.

    The constructor raises DriverError if the controller does not respond or is not suitable. ``wire`` and
    ``idle`` are for tests, whose clock does not advance automatically.
    """

    def __init__(
        self,
        config: GrblConfig,
        clock: Clock,
        wire: Wire | None = None,
        idle: Callable[[], None] = lambda: None,
    ) -> None:
        self._clock = clock
        self._idle = idle
        self._wire = wire
        self._trips = 0
        self.controller = Controller(config, wire or open_wire(config.table.port, config.table.baud), clock)
        self.blocks = GrblBlocks(self.controller)
        self.spindle = GrblSpindle(self.controller, self.blocks)
        self.encoder = GrblEncoder(self.controller)
        self.inputs = GrblInputs(self.controller, self.blocks)
        self.io = GrblIO(self.controller, self.blocks, self.inputs)
        self.axes = GrblAxes(self.controller, self.blocks, self.pump, self._reopen)
        self.blocks.terminals = self.io.able
        self.touch = GrblProbe(self.controller, self.axes, self.inputs) if PROBE in config.inputs else None
        voided = self.controller.on_void

        def void() -> None:
            voided()
            self.spindle.voided()
            self.io.voided()

        self.controller.on_void = void
        self._connect()
        self.panel = PanelStation(clock, self.inputs.states)
        self.ports = MachinePorts(
            clock=clock,
            axes=self.axes,
            spindle=self.spindle,
            io=self.io,
            station=self.panel,
            warnings=self._warnings(),
            blocks=self.blocks,
            halt=self.controller.halt,
            touch=self.touch,
            unknown=self.unknown,
            trips=self,
        )

    def pump(self) -> None:
        """Run one cycle of all parts without waiting."""
        self.controller.pump()
        self.blocks.pump()
        self.spindle.pump()
        self.io.pump()
        self.inputs.pump()
        if self.touch is not None:
            self.touch.pump()

    def unknown(self) -> frozenset[Unknown]:
        """Return the states that are unknown because the controller is silent.

        A silent controller may continue its blocks, and its spindle may turn.
        """
        return ALL_UNKNOWN if self.controller.mute else frozenset()

    def tripped(self) -> Trip | None:
        """Return the functions that were still on after a silence, or None.

        The driver has switched this spindle and these outputs off after the silence.
        """
        found = self.controller.found_on
        if found is None:
            return None
        unheard, letters = found
        outputs = self.controller.config.outputs
        on = (name for name, output in outputs.items() if LETTERS.get(output.terminal, " ") in letters)
        return Trip(self._trips, unheard, bool({"S", "C"} & set(letters)), tuple(on), found=True)

    def acknowledge(self, trip: Trip) -> None:
        """Clear the trip that the control has handled."""
        if trip.number == self._trips:
            self._trips, self.controller.found_on = self._trips + 1, None

    def _reopen(self) -> Opening[Wire]:
        """Start to reopen the connection; the old one is closed first to release the port."""
        close, config = self.controller.close, self.controller.config

        def opened() -> Wire:
            close()
            return self._wire or open_wire(config.table.port, config.table.baud)

        return Opening(opened, at_once=self._wire is not None)

    def close(self) -> None:
        """Stop all motion, then close the connection."""
        self.axes.stop(Stop.RAMP_OFF)
        self._rounds(_LEAVING)
        self.controller.close()

    def _connect(self) -> None:
        c = self.controller
        c.run(grblhal_scripts.connect(c))
        self._rounds(_CONNECTING)
        if c.busy or c.identity is None or (c.fault and c.alarm == 0):
            c.close()
            raise DriverError(f"{c.config.table.port}: {c.fault or 'no response from controller'}")

    def _rounds(self, limit: float) -> None:
        end = self._clock.now() + limit
        while self.controller.busy and not self.controller.lost and self._clock.now() < end:
            self._idle()
            self.pump()
            self._clock.sleep_until(self._clock.now() + _ROUND)

    def _unlike(self) -> list[str]:
        """Return warnings about controller settings that differ from the machine file."""
        c = self.controller
        told: list[str] = []
        for axis in c.wired:
            speed, accel = c.speed_of(axis.name), c.figure(120, axis.name)
            if speed and not 0.99 * axis.vmax <= speed <= 1.01 * axis.vmax:
                told.append(
                    Message(
                        "{axis}: the controller allows {speed} mm/min, but the machine file specifies {vmax} "
                        "mm/min",
                        axis=axis.name,
                        speed=f"{60 * speed:.0f}",
                        vmax=f"{60 * axis.vmax:.0f}",
                    )
                )
            if 0.0 < accel < 0.99 * axis.amax:
                told.append(
                    Message(
                        "{axis}: the controller decelerates at {accel} mm/s² instead of {amax} mm/s²",
                        axis=axis.name,
                        accel=f"{accel:.0f}",
                        amax=f"{axis.amax:.0f}",
                    )
                )
        if c.config.own_spindle and 0.0 < self.spindle.highest < c.config.rpm_max:
            told.append(
                Message(
                    "spindle: $30 allows {highest} rpm, but the machine file specifies {rpm_max} rpm",
                    highest=f"{self.spindle.highest:g}",
                    rpm_max=f"{c.config.rpm_max:g}",
                )
            )
        return told

    def _homes(self) -> list[str]:
        """Return a warning about axes that need a home switch although homing is off in the controller."""
        if self.controller.homing:
            return []
        names = [axis.name for axis in self.controller.wired if not axis.absolute and axis.here is None]
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
            f"{name} ({each.terminal})": self.io.lacking(name) for name, each in config.outputs.items()
        }
        told = _grouped(outputs, "output {names}: {reason}", "outputs {names}: {reason}")
        inputs = {
            f"{name} ({config.inputs[name].terminal})": why for name, why in self.inputs.lacking().items()
        }
        told += _grouped(inputs, "input {names}: {reason}", "inputs {names}: {reason}")
        told += self._unlike() + self._homes()
        estop = self.controller.config.inputs.get(ESTOP)
        if estop is not None and estop.terminal == HARDWARE:
            told.append(
                "the E-stop acts only on the hardware: the controller does not detect it, and the "
                "screen does not show its state"
            )
        if "thread" not in self.blocks.caps:
            told.append("the controller does not report a spindle encoder, so threading is rejected")
        return told


def _grouped(lacking: Mapping[str, str], one: str, several: str) -> list[str]:
    """Return one sentence for all names with the same reason; a name without a reason is omitted."""
    reasons: dict[str, list[str]] = {}
    for name, reason in lacking.items():
        if reason:
            reasons.setdefault(reason, []).append(name)
    return [
        Message(one if len(names) == 1 else several, names=", ".join(names), reason=reason)
        for reason, names in reasons.items()
    ]
