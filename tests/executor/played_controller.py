"""A controller with a planner of its own, played by hand: it moves nothing, tests say what it has done."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field

from app.compose.backends.simulated_backend import create_simulation
from app.compose.machine.machine_files import load_machine
from core.block_ports import BlockOperation, BlockState
from core.executor.machine_context import MachineContext
from core.executor.snapshot import LogEvent
from core.executor.spindle_control import SpindleControl
from core.executor.station_signals import CommandedOutputs, StationSignals
from core.machine.machine_model import Machine
from drivers.wakeups import ManualClock


@dataclass
class PlayedController:
    """``ops`` are the blocks that it was given, ``asked`` what else was asked of it, in order."""

    max_queued_motion_s: float = 100.0
    css_max_rpm: float = math.inf
    room: int = 100  # blocks that it takes in all
    fast: float = 50.0  # mm/s of its slides
    capabilities: frozenset[str] = frozenset()
    done: int = 0
    resting: bool = True
    held: bool = False
    hindrance: str = ""
    jogs: bool = True  # there is a way before the limits
    ops: list[BlockOperation] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    jogged: list[tuple[str, float, float, tuple[float, float] | None]] = field(default_factory=list)
    steps: list[tuple[str, float, float]] = field(default_factory=list)

    def announce_css_max_rpm(self, max_rpm: float) -> None:
        """Not used here."""

    def get_max_directional_speed(self, _dx: float, _dz: float) -> float:
        return self.fast

    def submit_block(self, block: BlockOperation) -> int | None:
        if len(self.ops) >= self.room:
            return None
        self.ops.append(block)
        self.resting = False
        return len(self.ops)

    def finish(self) -> None:
        """All that it has is moved to its end."""
        self.done, self.resting = len(self.ops), True

    def state(self) -> BlockState:
        return BlockState(self.done, 0, self.resting, self.held, self.hindrance)

    def stop_on_path(self) -> None:
        self.asked.append("hold")

    def resume(self) -> None:
        self.asked.append("resume")

    def abort_blocks(self) -> None:
        self.asked.append("abort")

    def set_overrides(self, feed_fraction: float, rapid_fraction: float) -> None:
        """Not used here."""

    def start_jog(
        self, axis: str, velocity: float, lease_s: float, limits: tuple[float, float] | None
    ) -> bool:
        self.jogged.append((axis, velocity, lease_s, limits))
        return self.jogs

    def move_to_target(self, axis: str, target: float, speed: float) -> None:
        self.steps.append((axis, target, speed))

    def stop_jog(self) -> None:
        self.asked.append("jog stop")


def context_of(controller: PlayedController | None, machine: Machine | None = None) -> MachineContext:
    """What the executor's parts look at, at time 0, with the slides of the simulated machine at home."""
    model, clock, events = machine or load_machine(), ManualClock(), list[LogEvent]()
    ports = dataclasses.replace(create_simulation(model, clock).ports, blocks=controller)
    return MachineContext(
        machine=model,
        ports=ports,
        handle_event=events.append,
        spindle=SpindleControl(ports.spindle, model.spindle),
        now=clock.now(),
        axis_sample=ports.axes.sample(),
        inputs=dict(ports.io.inputs()),
        commanded_outputs=CommandedOutputs(ports.io, model.outputs),
    )


def turn_feed_pot(context: MachineContext, feed: float) -> None:
    """The pot of the feed stands at this fraction."""
    context.station_signals = StationSignals(
        is_estop_pressed=False,
        is_start_requested=False,
        is_hold_requested=False,
        feed_override=feed,
        spindle=1.0,
        is_spindle_in_auto=True,
        station_fault="",
    )
