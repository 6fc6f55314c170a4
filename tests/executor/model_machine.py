"""A simulated machine for the model: its ports break, freeze and stall; each tick is checked.

What the machine really does comes from the simulated plant and not from what the executor says.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

from core.executor.commands import Command
from core.executor.executor import Executor
from core.executor.job import Job, ProgramPass
from core.executor.snapshot import (
    ACTIVE_STATES,
    CYCLE_STATES,
    MANUAL_STATES,
    STOPPED_STATES,
    MachineState,
    Snapshot,
)
from core.executor.start_conditions import MIN_READING_TIME_S
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup
from core.ports import UnknownPart
from tests.executor.rig import Rig
from tests.texts import pattern

STARTS_FROM = {
    MachineState.IDLE,
    MachineState.HOLD,
    MachineState.STOPPING,
    MachineState.SINGLE_BLOCK_STOP,
    MachineState.PROGRAM_STOP,
}
MOVES = ACTIVE_STATES | {MachineState.JOG, MachineState.HOMING}
SETTLES = 0.6  # s: the drives' own braking from full speed, and the lag behind it
LONGEST_JOG = 8.0  # s; the handwheel's way is long, and the host may be late by 5 s
RUNS_OUT = 12.0  # s; the spindle's own ramp from full speed, bogged or not
POWER_SEEN = 0.2  # s until drives that are off are told
NO_NEWS = 0.25  # s without news of the slides after which nothing may move on
STILL = 0.02  # mm in a tick; servo noise and the last of a lag are less
ON_PATH = 0.005  # mm
FINE = 0.002  # s between two looks at the setpoints
UNHEARD = 0.1  # s after which a driver reports that what it tells is old
PORTS = ("axes", "spindle", "io")
FREEZES = {  # what a port goes on telling, and what it reports as unknown then
    "axes": (("sample",), UnknownPart.AXES),
    "spindle": (("speed", "read_angle", "read_fault"), UnknownPart.SPINDLE),
    "io": (("inputs", "get_outputs"), UnknownPart.INPUTS),
}


class Breaking:
    """A port whose next call of one method raises or takes long, or that goes on telling what is old."""

    def __init__(self, port: object, advance: Callable[[float], None]) -> None:
        self._port = port
        self._advance = advance
        self.breaks: dict[str, tuple[Exception, int]] = {}
        self.stalls: dict[str, float] = {}  # s for which the process stands still inside the next call
        self.frozen: dict[str, Any] = {}  # what each frozen method returns

    def freeze(self, methods: tuple[str, ...]) -> None:
        """From now on these return what they return now."""
        self.frozen = {name: getattr(self._port, name)() for name in methods}

    def __getattr__(self, name: str) -> Any:
        if name in self.stalls:
            self._advance(self.stalls.pop(name))
        if name in self.frozen:
            return lambda: self.frozen[name]
        whole = getattr(self._port, name)
        if name not in self.breaks:
            return whole

        def raising(*given: Any, **words: Any) -> Any:
            error, left = self.breaks[name]
            if left > 1:
                self.breaks[name] = (error, left - 1)
            else:
                del self.breaks[name]
            raise error

        return raising


class Seen:
    """What a run of the model has met; for the table of the benchmark."""

    def __init__(self) -> None:
        self.steps = self.ticks = self.runs = self.parts = 0
        self.seconds = 0.0
        self.states: Counter[MachineState] = Counter()
        self.changes: Counter[tuple[MachineState, MachineState]] = Counter()
        self.alarms: Counter[str] = Counter()
        self.rules: Counter[str] = Counter()


SEEN = Seen()


class Machine(Rig):
    """A rig whose ports break and that checks every tick."""

    def _passes(self, job: Job, setup: InterpreterSetup) -> ProgramPass:
        self.blocks: list[Block] = []
        whole = super()._passes(job, setup)
        return whole._replace(block_iterator=self._kept(whole.block_iterator))

    def _kept(self, blocks: Iterator[Block]) -> Iterator[Block]:
        for block in blocks:
            self.blocks.append(block)
            yield block

    def __post_init__(self) -> None:
        super().__post_init__()
        ports = self.sim.ports
        self.broken = {name: Breaking(getattr(ports, name), self._stall) for name in PORTS}
        axes, spindle, io = (self.broken[name] for name in PORTS)
        self.sim = self.sim._replace(
            ports=dataclasses.replace(ports, axes=axes, spindle=spindle, io=io, unknown=self._unheard)
        )
        self.true_ports = ports
        self.frozen_since: dict[str, float] = {}  # s of the clock, by port
        self.owed: list[tuple[int, Command]] = []  # releases that come late: in so many ticks
        self.blind = False  # an encoder may tell what is not so
        self.harmed = False  # something was broken, late or stopped: alarms have a reason
        self._stalled = 0.0  # s for which the process stood still inside this tick
        self._fed_badly_before = False
        self._begin()

    def _begin(self) -> None:
        """TurnDesk is started on this machine."""
        self.executor = Executor(
            self.machine, self.sim.ports, self.events.append, self._passes, self.notes.append, self.left
        )
        self.pressed = self.jogged = self.homed = self.switched = False  # since the tick before
        self.unexpected = False  # a driver has raised what no driver may
        self.jog_asked = 0.0
        self.stood = -1e9  # when the last state in which slides move was left
        self.last_press = -1e9  # when a start was last asked for, by palms or from the screen
        self.fed_badly = self.stopped = self.powerless = self.moved_unseen = 0.0
        self.announced = 0.0  # s for which the start of the spindle has stood in the snapshot
        self.before = self.shot
        self.executor.run_tick()

    def close(self) -> None:
        """TurnDesk is closed: nothing may be left moving or switched on. It is started again afterwards."""
        self.executor.shut_down()
        for port in self.broken.values():
            port.breaks.clear()
        hands, began = self.sim.machine, self.clock.now()
        for _ in range(round(RUNS_OUT / self.every)):
            place = hands.get_true_positions()
            self.clock.advance(self.every)
            way = math.dist(hands.get_true_positions()[:2], place[:2])
            at_rest = self.clock.now() - began > SETTLES
            assert not at_rest or way < STILL or self.blind, f"{way} mm after TurnDesk was closed"
        assert not self.true_ports.axes.sample().enabled, "the drives are on after TurnDesk was closed"
        assert abs(hands.get_spindle_rpm()) < 1.0, "the spindle turns after TurnDesk was closed"
        assert not self.true_ports.io.get_outputs()["coolant"], "the coolant is on"
        self.left = self.notes[-1] if self.notes else None
        self.owed.clear()
        self._begin()

    # --- what breaks --------------------------------------------------------------------------------------

    def freeze(self, port: str) -> None:
        """This port goes on telling what it tells now."""
        self.broken[port].freeze(FREEZES[port][0])
        self.frozen_since[port] = self.clock.now()

    def thaw(self) -> None:
        """Every port tells what is."""
        self.frozen_since.clear()
        for port in self.broken.values():
            port.frozen.clear()

    def _unheard(self) -> frozenset[UnknownPart]:
        now = self.clock.now()
        old = {FREEZES[port][1] for port, since in self.frozen_since.items() if now - since > UNHEARD}
        return frozenset(old) | self.true_ports.unknown()

    def _stall(self, seconds: float) -> None:
        self._stalled += seconds
        self.clock.advance(seconds)

    # --- time ---------------------------------------------------------------------------------------------

    def tick(self, dt: float | None = None) -> None:
        """One tick, and all that must hold after it."""
        dt = self.every if dt is None else dt
        before, place = self.shot, self.sim.machine.get_true_positions()
        self._setpoints(dt)
        self.clock.advance(dt)
        self._release()
        queue, self._stalled = self._demand(), 0.0
        self.executor.run_tick()
        dt += self._stalled
        if not self._stalled:
            self._spliced(queue)
        SEEN.ticks += 1
        SEEN.seconds += dt
        after = self.shot
        SEEN.states[after.state] += 1
        if before.state is not after.state:
            SEEN.changes[before.state, after.state] += 1
        for alarm in after.alarms:
            if alarm not in before.alarms:
                SEEN.alarms[alarm.code] += 1
        self._check(before, after, place, dt)
        self.pressed = self.jogged = self.homed = self.switched = False

    def _release(self) -> None:
        for ticks, command in self.owed:
            if ticks == 0:
                self.executor.post(command)
        self.owed = [(ticks - 1, command) for ticks, command in self.owed if ticks]

    def _demand(self) -> tuple[tuple[float, ...], tuple[float, ...], bool]:
        axes = self.true_ports.axes
        return *axes.demand_at(self.clock.now()), axes.sample().enabled

    def _spliced(self, before: tuple[tuple[float, ...], tuple[float, ...], bool]) -> None:
        """A tick changes neither where the setpoints are nor how fast; only power that goes may."""
        p, v, on = self._demand()
        if not (on and before[2]) or self._geared():
            return
        for axis, p0, p1, v0, v1 in zip(self.machine.axes, before[0], p, before[1], v, strict=True):
            assert abs(p1 - p0) < 1e-6, f"{axis.name} leaps by {p1 - p0}"
            assert abs(v1 - v0) < 1e-3 * axis.max_speed + 1e-6, (
                f"{axis.name} changes its speed at once: {v0} to {v1}"
            )

    def _setpoints(self, dt: float) -> None:
        """What is queued for the time until the next tick: within the limits, without a leap."""
        axes, now = self.true_ports.axes, self.clock.now()
        if not axes.sample().enabled or self._geared():
            return
        steps = min(max(round(dt / FINE), 1), 60)
        looks = [axes.demand_at(now + k * dt / steps) for k in range(steps + 1)]
        corner = self.machine.timing.setpoint_duration_s  # s in which a corner may turn
        for (p0, v0), (p1, v1) in pairwise(looks):
            h = dt / steps
            for axis, a, b, va, vb in zip(self.machine.axes, p0, p1, v0, v1, strict=True):
                assert abs(vb) <= axis.max_speed * 1.001 + 1e-6, f"{axis.name} at {vb}"
                assert abs(b - a) <= max(abs(va), abs(vb)) * h + axis.max_acceleration * h * h + 1e-6, (
                    f"{axis.name} leaps"
                )
                assert abs(vb - va) <= axis.max_acceleration * 1.02 * (h + corner) + 1e-3 * axis.max_speed, (
                    f"{axis.name} at {va} then {vb}"
                )

    def _geared(self) -> bool:
        gear = self.true_ports.gear
        return gear is not None and gear.geared() is not None

    # --- invariants ---------------------------------------------------------------------------------------

    def _check(self, old: Snapshot, new: Snapshot, place: tuple[float, ...], dt: float) -> None:
        if old.state in MOVES and new.state not in MOVES:
            self.stood = new.t
        told = any(re.search(pattern("executor.spindle-starts"), said) for said in old.announced)
        self.announced = self.announced + dt if told else 0.0
        self._nothing_moves_unasked(old, new, place, dt)
        self._the_spindle_waits(old, new)
        self._feeds_as_commanded(new)
        self._known(new)
        self._on_the_path(new)
        self._stopped_is_off(new, dt)
        self._power_is_seen(old, new, dt)
        self._jog_ends(new)
        self._frozen_is_seen(new, dt)
        assert self.harmed or not new.alarms, f"an alarm although nothing was broken: {new.alarms}"
        if not self.unexpected:
            assert all(alarm.code != "internal" for alarm in new.alarms), new.alarms

    def _nothing_moves_unasked(
        self, old: Snapshot, new: Snapshot, place: tuple[float, ...], dt: float
    ) -> None:
        begins = old.state not in ACTIVE_STATES or (
            old.state is MachineState.STOPPING and new.state is not MachineState.STOPPING
        )
        if new.state in ACTIVE_STATES and begins:
            assert self.pressed, f"{old.state} became {new.state} and nobody pressed a start"
            assert old.state in STARTS_FROM, f"a cycle was started from {old.state}"
        if new.state is MachineState.JOG and old.state is not MachineState.JOG:
            assert self.jogged, f"{old.state} became a jog and nobody asked for one"
        if new.state is MachineState.HOMING and old.state is not MachineState.HOMING:
            assert self.homed
        way = math.dist(self.sim.machine.get_true_positions()[:2], place[:2])
        if new.state not in MOVES and new.t - self.stood > SETTLES + dt:
            # How far a slide goes behind an encoder that stands is measured in test_following_error.
            assert way < STILL or self.blind, f"{way} mm in {new.state}"

    def _the_spindle_waits(self, old: Snapshot, new: Snapshot) -> None:
        """From no command to one: a word of the program under way, a start that was announced, the switch."""
        if old.rpm_command != 0.0 or new.rpm_command == 0.0:
            return
        fresh = old.requested_rpm == 0.0 and (
            new.state in ACTIVE_STATES or old.state in ACTIVE_STATES or self.pressed
        )
        word = any(code in new.block_text for code in ("M03", "M04")) and old.state in ACTIVE_STATES
        announced = self.pressed and self.announced > MIN_READING_TIME_S - 1e-6
        switched = self.switched and new.state in MANUAL_STATES and self.announced > MIN_READING_TIME_S - 1e-6
        assert fresh or word or announced or switched, (
            f"the spindle starts by itself in {new.state}: {old.announced}"
        )

    def _feeds_as_commanded(self, new: Snapshot) -> None:
        """A cut with the spindle or the coolant not as the program has it ends within half a second."""
        cutting = (
            new.state is MachineState.RUN and not new.rapid and new.velocity > 0.05 and not new.modal.c_locked
        )
        bad = cutting and (
            (
                new.modal.spindle != 0
                and abs(self.sim.machine.get_spindle_rpm()) < 0.3 * abs(new.rpm_command) - 30.0
            )
            or (new.modal.spindle != 0 and new.rpm_command == 0.0)
            or (new.modal.coolant and "coolant" not in new.outputs)
        )
        # The time between two snapshots counts when both show it: in a long tick it may just have begun.
        both = bad and self._fed_badly_before
        self.fed_badly = self.fed_badly + (new.t - self.before.t) if both else 0.0
        self.before, self._fed_badly_before = new, bad
        assert self.fed_badly < 1.2, f"it cuts in line {new.line} at {self.sim.machine.get_spindle_rpm()} rpm"

    def _known(self, new: Snapshot) -> None:
        """At rest the place on the screen is the place of the slides, or the screen says that it is not."""
        if (
            self.blind
            or self.frozen_since
            or new.state in MOVES
            or new.alarms
            or new.state in {MachineState.ESTOP, MachineState.DISABLED}
        ):
            return
        if new.t - self.stood > SETTLES and all(new.homed):
            true = self.sim.machine.get_true_positions()
            assert max(abs(a - b) for a, b in zip(new.actual, true, strict=True)) < 0.2, (new.actual, true)

    def _stopped_is_off(self, new: Snapshot, dt: float) -> None:
        """An alarm and the E-stop leave no command to the spindle, and it comes to rest, whatever it did."""
        off = new.state in {MachineState.FAULT, MachineState.ESTOP} and not self.unexpected
        self.stopped = self.stopped + dt if off else 0.0
        if self.stopped > 2 * dt:  # an output that cannot be read makes the picture one tick old
            assert new.rpm_command == 0.0, f"{new.rpm_command} rpm in {new.state}"
        if self.stopped > RUNS_OUT:
            assert abs(self.sim.machine.get_spindle_rpm()) < 1.0, f"it turns in {new.state}"

    def _power_is_seen(self, old: Snapshot, new: Snapshot, dt: float) -> None:
        """Drives that are off end every state in which something may move or be started."""
        on = self.true_ports.axes.sample().enabled
        dark = not on and new.state not in {MachineState.DISABLED, MachineState.FAULT, MachineState.ESTOP}
        self.powerless = self.powerless + dt if dark and old.state is new.state else 0.0
        seen = POWER_SEEN + ("axes" in self.frozen_since) * (UNHEARD + NO_NEWS)
        assert self.powerless <= max(seen, dt), f"{new.state} without power for {self.powerless:.2f} s"

    def _frozen_is_seen(self, new: Snapshot, dt: float) -> None:
        """A control that hears nothing of the slides soon moves nothing, and is not ready."""
        frozen = "axes" in self.frozen_since and new.state in CYCLE_STATES | {
            MachineState.IDLE,
            MachineState.JOG,
            MachineState.HOMING,
        }
        self.moved_unseen = self.moved_unseen + dt if frozen else 0.0
        assert self.moved_unseen <= UNHEARD + NO_NEWS + 2 * dt, f"{new.state} without news of the slides"

    def _jog_ends(self, new: Snapshot) -> None:
        """Nothing is jogged for longer than its lease, its step and the braking take."""
        if self.jogged or new.state is not MachineState.JOG:
            self.jog_asked = new.t
        assert new.t - self.jog_asked < LONGEST_JOG, f"jogged for {new.t - self.jog_asked:.1f} s"

    def _on_the_path(self, new: Snapshot) -> None:
        """Wherever a cycle was stopped: on a line or circle of its program."""
        if new.state not in STOPPED_STATES or new.t - self.stood < SETTLES or new.waiting_for == "THREAD":
            return
        x, z = new.demand[:2]
        off = min((_off(block, x, z) for block in self.blocks if block.moves), default=0.0)
        assert off < ON_PATH, f"{off} mm off the path in {new.state}, line {new.line}"


def _off(block: Block, x: float, z: float) -> float:
    """Distance of a place from the way of a block, mm, machine coordinates."""
    ax, az, bx, bz = block.x0 + block.offset_x, block.z0 + block.offset_z, block.mx, block.mz
    if block.kind is BlockKind.ARC:
        cx, cz = block.cx + block.offset_x, block.cz + block.offset_z
        return abs(math.hypot(x - cx, z - cz) - math.hypot(ax - cx, az - cz))
    long = (bx - ax) ** 2 + (bz - az) ** 2
    part = min(max(((x - ax) * (bx - ax) + (z - az) * (bz - az)) / long, 0.0), 1.0) if long else 0.0
    return math.hypot(x - ax - part * (bx - ax), z - az - part * (bz - az))
