"""Axes of the controller for the executor: asked and told as any others, but they take no setpoints."""

from __future__ import annotations

from collections.abc import Callable

from core.ports import AxisSample, DriverError, Segments, Stop
from drivers.grblhal import grblhal_codes, grblhal_scripts
from drivers.grblhal.grblhal_blocks import GrblBlocks
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_wire import Wire
from drivers.waiting import Opening

_REPORTED = 0.002  # mm between where a block has ended and a report, which has three decimals
_STEPS = 100  # setting, steps in a millimetre


class GrblAxes:
    """``core.ports.AxisSink``; ``pump`` is the driver's round, made when the executor looks at the axes."""

    commit = 0.0

    def __init__(
        self,
        controller: Controller,
        blocks: GrblBlocks,
        pump: Callable[[], None],
        reopen: Callable[[], Opening[Wire]],
    ) -> None:
        """``reopen`` begins to open the wire anew."""
        self._c = controller
        self._reopen = reopen
        self._blocks = blocks
        self._pump = pump
        self.axes = tuple(axis.name for axis in controller.config.axes)
        self._known = {axis.name: axis.absolute or not axis.wired for axis in controller.config.axes}
        self._wired = {axis.name for axis in controller.wired}
        self._homing = ""

    def now(self) -> float:
        """The host's clock: the controller has none to ask for."""
        return self._c.clock.now()

    def horizon(self) -> float:
        """Now: nothing is queued by time."""
        return self.now()

    def splice(self, segments: Segments) -> None:  # noqa: ARG002  the port's
        """Raises DriverError always."""
        raise DriverError(
            "this controller plans its own motion; it accepts blocks, not setpoints", reason="blocks-only"
        )

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:  # noqa: ARG002  at rest only
        """Where the slides rest, exactly as the last block said it where that is known."""
        return self._places(), (0.0,) * len(self.axes)

    def sample(self) -> AxisSample:
        """As last reported."""
        self._pump()
        c = self._c
        if c.restarted:
            c.restarted = False
            self._forget_places()
        if c.fault or not c.trusted:
            self._homing = ""
        if self._homing and not c.busy and (c.ready or c.is_homed(self._homing)):
            self._known[self._homing], self._homing = True, ""
        places = self._places()
        return AxisSample(
            t=c.heard_at,
            demand=places,
            actual=places,
            following_error=(0.0,) * len(self.axes),
            enabled=self._blocks.powered and not c.fault,
            homed=tuple(self._is_known(name) for name in self.axes),
            moving=not self._blocks.state().resting,
            fault=c.fault,
        )

    def enable(self, on: bool) -> None:
        """The control's own leave to move; raises DriverError while a fault stands."""
        if on and self._c.fault:
            raise DriverError(
                "the controller stays locked: {fault}; press Reset first", "no-power", fault=self._c.fault
            )
        self._blocks.powered = on

    def stop(self, how: Stop) -> None:
        """The controller's own stop; without power it takes nothing more."""
        self._blocks.powered = self._blocks.powered and how is Stop.RAMP_HOLD
        if self._c.alarm not in grblhal_codes.ENDED:
            self._blocks.abort()

    def home(self, axis: str) -> None:
        """Begin to look for a switch. Raises DriverError."""
        axes = {each.name: each for each in self._c.config.axes}
        if axis not in axes or not axes[axis].wired:
            raise DriverError(
                "the controller does not have an axis {axis} to home", reason="no-axis", axis=f"{axis!r}"
            )
        self._blocks.demand_power()
        if self._blocks.hindrance() and self._c.alarm == 0:
            raise DriverError(
                "{axis} cannot home: {hindrance}", "homing", axis=axis, hindrance=self._blocks.hindrance()
            )
        self._known[axis], self._homing = False, axis
        self._c.trusted = True
        self._blocks.home(axis)

    def clear_fault(self) -> None:
        """The operator has seen it: reset, unlock, verify. A wire that is gone is opened anew; why
        it cannot be is the next fault.
        """
        self._blocks.powered = False
        if not self._c.trusted:
            self._forget_places()
        if self._c.lost:
            self._c.reconnect(self._reopen(), lambda: grblhal_scripts.reconnect(self._c))
        elif self._c.fault:
            self._c.fault = ""
            self._c.run(grblhal_scripts.recover(self._c))

    def _forget_places(self) -> None:
        """What the controller only counts may be anywhere; where it homes by itself its own word counts."""
        self._known = {axis.name: not axis.wired for axis in self._c.config.axes}

    def _is_known(self, name: str) -> bool:
        """The controller's own word counts where it homes; where it does not, the machine file's."""
        told = self._c.is_homed(name)
        known = self._known[name] if told is None or name not in self._wired else told
        return known and self._c.trusted and self._homing != name

    def _places(self) -> tuple[float, ...]:
        places = [self._c.position.get(name, 0.0) for name in self.axes]
        rest = self._blocks.rest
        if rest is not None:
            for i, exact in enumerate(rest):
                places[i] = exact if abs(places[i] - exact) <= self._grain(self.axes[i]) else places[i]
        return tuple(places)

    def _grain(self, name: str) -> float:
        """mm: half a step of the controller, and its rounding."""
        steps = self._c.figure(_STEPS, name)
        return max(_REPORTED, 0.5 / steps + 0.001) if steps else _REPORTED
