"""A model of the executor: what an operator does, what breaks and how late the host is, in any order.

The invariants are looked at after every tick, on the step clock; what the machine really does comes from the
simulated plant and not from what the executor says. In the end all faults are mended, and the machine must
make a part: no state may be one that cannot be left.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule

from app.compose.workshop import proof_of
from core.executor.commands import (
    Command,
    CycleStart,
    EnableDrives,
    FeedHold,
    FeedOverride,
    ForceOutput,
    Home,
    Jog,
    JogStep,
    JogStop,
    Prepare,
    Reset,
    SetSwitch,
    SpindleLimit,
    SpindleStop,
    Wheel,
    WheelOff,
)
from core.executor.executor import Executor
from core.executor.job import Job
from core.executor.read_ahead import ProgramPass
from core.executor.snapshot import ACTIVE, BY_HAND, CYCLE, STOPPED, Snapshot, Starts, State
from core.executor.start_conditions import TIME_TO_READ
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.job_setup import Setup, ToolOffset
from core.ports import DriverError
from core.proving.prove_program import prove
from tests.executor.lines import line_job, restart_job
from tests.executor.rig import TICK, Rig
from tests.texts import pattern

TOOLS = {1: ToolOffset(), 2: ToolOffset(x=1.0, z=-2.0)}
PROGRAMS = (
    "G90G94F300\nX.3Z.3\nX.3\nG01X.4F20\nX.4\nZ.2\nM30\n",
    "G90G94F300\nM03S1000\nM08\nX.5Z.1\nG01X.4Z-.2F5\nX.6\nM09\nM30\n",
    "G90G94F300\nM03S1500\nX.5Z.1\nG95G01Z-.3F.01\nX.7\nG94M05\nM30\n",
    "G90G94F300\nM03S600\nX.5Z.1\nG33X.48Z-.3I.02K.05\nG00X1\nM30\n",
    "G90G94F300\nX.2\nG04F.3\nM00\nX.3\nM01\nX0Z0\nM30\n",
    "G90G94F300\nG01X.2F30\nG02X.2Z-.2I.2K-.1\nX.3Z-.3\nM30\n",
    "G90G94F300\nT1\nX.3Z.2\nT2\nX.3Z.2\nG01Z.1F20\nM30\n",
    "G90G94F300\nM05\nM19\nC90\nG01C180F600\nC180\nM05\nM30\n",
    "G90G94F300\nM03S800\nG04F.2\nM04S800\nG01X.2F10\nM05\nM13\nM12\nM02\n",
    "G90G94F300\nG96S200M03\nX1Z.1\nG94G01X.2F20\nG97\nM30\n",
    "G90G94F300\nM03S900\nX.5Z.1\nLS3\nG91G01X-.05F10\nZ-.1\nG00Z.1\nLF\nG90X.5\nM05\nM30\n",
    "G90G94F300\nM03S1200\nM08\nX.5Z.1\nG01Z-3.F15\nX.6\nM09\nM05\nM30\n",
)
LINES = ("X.2", "Z.2", "G01X.1F20", "M03S500", "M05", "G04F.3", "G91X.05", "G90", "T1", "M08", "M09", "M30")
SAFE = "G90G94F300\nX.05\nX0\nM30\n"
STARTS_FROM = {State.IDLE, State.HOLD, State.HOLDING, State.BLOCK_END, State.PROGRAM_STOP}
MOVES = ACTIVE | {State.JOG, State.HOME}
SETTLES = 0.6  # s: the drives' own braking from full speed, and the lag behind it
LONGEST_JOG = 8.0  # s; the handwheel's way is long, and the host may be late by 5 s
RUNS_OUT = 12.0  # s; the spindle's own ramp from full speed, bogged or not
POWER_SEEN = 0.2  # s until drives that are off are told
BOUNCE = 0.31  # s in which a second start is the same press
STILL = 0.02  # mm in a tick; servo noise and the last of a lag are less
ON_PATH = 0.005  # mm
FINE = 0.002  # s between two looks at the setpoints
_PORTS = ("axes", "spindle", "io")
_CALLS = {
    "axes": ("sample", "splice", "demand_at", "horizon", "stop", "enable", "clear_fault", "now"),
    "spindle": ("run", "coast", "speed", "angle", "fault"),
    "io": ("inputs", "outputs", "write", "safe"),
}


class Breaking:
    """A port whose next call of one method raises."""

    def __init__(self, port: object) -> None:
        self._port = port
        self.breaks: dict[str, tuple[Exception, int]] = {}

    def __getattr__(self, name: str) -> Any:
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
        self.states: Counter[State] = Counter()
        self.changes: Counter[tuple[State, State]] = Counter()
        self.alarms: Counter[str] = Counter()
        self.rules: Counter[str] = Counter()


SEEN = Seen()


class Machine(Rig):
    """A rig whose ports break and that checks every tick."""

    def _passes(self, job: Job, setup: Setup) -> ProgramPass:
        self.blocks: list[Block] = []
        whole = super()._passes(job, setup)
        return whole._replace(blocks=self._kept(whole.blocks))

    def _kept(self, blocks: Iterator[Block]) -> Iterator[Block]:
        for block in blocks:
            self.blocks.append(block)
            yield block

    def __post_init__(self) -> None:
        super().__post_init__()
        ports = self.sim.ports
        self.broken = {name: Breaking(getattr(ports, name)) for name in _PORTS}
        axes, spindle, io = (self.broken[name] for name in _PORTS)
        self.sim = self.sim._replace(ports=dataclasses.replace(ports, axes=axes, spindle=spindle, io=io))
        self.executor = Executor(self.machine, self.sim.ports, self.events.append, self._passes)
        self.true_ports = ports
        self.pressed = self.jogged = self.homed = self.switched = False  # since the tick before
        self.unexpected = False  # a driver has raised what no driver may
        self.blind = False  # an encoder may tell what is not so
        self.jog_asked = 0.0
        self.stood = -1e9  # when the last state in which slides move was left
        self.last_press = -1e9  # when a start was last asked for, by palms or from the screen
        self.fed_badly = self.stopped = self.powerless = 0.0
        self.announced = 0.0  # s for which the start of the spindle has stood in the snapshot
        self.before = self.shot
        self.executor.tick()

    # --- time ---------------------------------------------------------------------------------------------

    def tick(self, dt: float | None = None) -> None:
        """One tick, and all that must hold after it."""
        dt = self.every if dt is None else dt
        before, place = self.shot, self.sim.machine.true_position()
        self._setpoints(dt)
        self.clock.advance(dt)
        queue = self._demand()
        self.executor.tick()
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
            assert abs(v1 - v0) < 1e-3 * axis.vmax + 1e-6, (
                f"{axis.name} changes its speed at once: {v0} to {v1}"
            )

    def _setpoints(self, dt: float) -> None:
        """What is queued for the time until the next tick: within the limits, without a leap."""
        axes, now = self.true_ports.axes, self.clock.now()
        if not axes.sample().enabled or self._geared():
            return
        steps = min(max(round(dt / FINE), 1), 60)
        looks = [axes.demand_at(now + k * dt / steps) for k in range(steps + 1)]
        corner = self.machine.timing.setpoint  # s in which a corner may turn
        for (p0, v0), (p1, v1) in pairwise(looks):
            h = dt / steps
            for axis, a, b, va, vb in zip(self.machine.axes, p0, p1, v0, v1, strict=True):
                assert abs(vb) <= axis.vmax * 1.001 + 1e-6, f"{axis.name} at {vb}"
                assert abs(b - a) <= max(abs(va), abs(vb)) * h + axis.amax * h * h + 1e-6, (
                    f"{axis.name} leaps"
                )
                assert abs(vb - va) <= axis.amax * 1.02 * (h + corner) + 1e-3 * axis.vmax, (
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
        if not self.unexpected:
            assert all(alarm.code != "internal" for alarm in new.alarms), new.alarms

    def _nothing_moves_unasked(
        self, old: Snapshot, new: Snapshot, place: tuple[float, ...], dt: float
    ) -> None:
        begins = old.state not in ACTIVE or (old.state is State.HOLDING and new.state is not State.HOLDING)
        if new.state in ACTIVE and begins:
            assert self.pressed, f"{old.state} became {new.state} and nobody pressed a start"
            assert old.state in STARTS_FROM, f"a cycle was started from {old.state}"
        if new.state is State.JOG and old.state is not State.JOG:
            assert self.jogged, f"{old.state} became a jog and nobody asked for one"
        if new.state is State.HOME and old.state is not State.HOME:
            assert self.homed
        way = math.dist(self.sim.machine.true_position()[:2], place[:2])
        if new.state not in MOVES and new.t - self.stood > SETTLES + dt:
            # How far a slide goes behind an encoder that stands is measured in test_following_error.
            assert way < STILL or self.blind, f"{way} mm in {new.state}"

    def _the_spindle_waits(self, old: Snapshot, new: Snapshot) -> None:
        """From no command to one: a word of the program under way, a start that was announced, the switch."""
        if old.rpm_command != 0.0 or new.rpm_command == 0.0:
            return
        fresh = old.spindle_asked == 0.0 and (new.state in ACTIVE or old.state in ACTIVE or self.pressed)
        word = any(code in new.block_text for code in ("M03", "M04")) and old.state in ACTIVE
        announced = self.pressed and self.announced > TIME_TO_READ - 1e-6
        switched = self.switched and new.state in BY_HAND and self.announced > TIME_TO_READ - 1e-6
        assert fresh or word or announced or switched, (
            f"the spindle starts by itself in {new.state}: {old.announced}"
        )

    def _feeds_as_commanded(self, new: Snapshot) -> None:
        """A cut with the spindle or the coolant not as the program has it ends within half a second."""
        cutting = new.state is State.RUN and not new.rapid and new.velocity > 0.05 and not new.modal.c_locked
        bad = cutting and (
            (
                new.modal.spindle != 0
                and abs(self.sim.machine.spindle_rpm()) < 0.3 * abs(new.rpm_command) - 30.0
            )
            or (new.modal.spindle != 0 and new.rpm_command == 0.0)
            or (new.modal.coolant and "coolant" not in new.outputs)
        )
        self.fed_badly = self.fed_badly + (new.t - self.before.t) if bad else 0.0
        self.before = new
        assert self.fed_badly < 1.2, f"it cuts in line {new.line} at {self.sim.machine.spindle_rpm()} rpm"

    def _known(self, new: Snapshot) -> None:
        """At rest the place on the screen is the place of the slides, or the screen says that it is not."""
        if self.blind or new.state in MOVES or new.alarms or new.state in {State.ESTOP, State.DISABLED}:
            return
        if new.t - self.stood > SETTLES and all(new.homed):
            true = self.sim.machine.true_position()
            assert max(abs(a - b) for a, b in zip(new.actual, true, strict=True)) < 0.2, (new.actual, true)

    def _stopped_is_off(self, new: Snapshot, dt: float) -> None:
        """An alarm and the E-stop leave no command to the spindle, and it comes to rest, whatever it did."""
        off = new.state in {State.FAULT, State.ESTOP} and not self.unexpected
        self.stopped = self.stopped + dt if off else 0.0
        if self.stopped > 2 * dt:  # an output that cannot be read makes the picture one tick old
            assert new.rpm_command == 0.0, f"{new.rpm_command} rpm in {new.state}"
        if self.stopped > RUNS_OUT:
            assert abs(self.sim.machine.spindle_rpm()) < 1.0, f"it turns in {new.state}"

    def _power_is_seen(self, old: Snapshot, new: Snapshot, dt: float) -> None:
        """Drives that are off end every state in which something may move or be started."""
        on = self.true_ports.axes.sample().enabled
        dark = not on and new.state not in {State.DISABLED, State.FAULT, State.ESTOP}
        self.powerless = self.powerless + dt if dark and old.state is new.state else 0.0
        assert self.powerless <= max(POWER_SEEN, dt), f"{new.state} without power for {self.powerless:.2f} s"

    def _jog_ends(self, new: Snapshot) -> None:
        """Nothing is jogged for longer than its lease, its step and the braking take."""
        if self.jogged or new.state is not State.JOG:
            self.jog_asked = new.t
        assert new.t - self.jog_asked < LONGEST_JOG, f"jogged for {new.t - self.jog_asked:.1f} s"

    def _on_the_path(self, new: Snapshot) -> None:
        """Wherever a cycle was stopped: on a line or circle of its program."""
        if new.state not in STOPPED or new.t - self.stood < SETTLES or new.waiting_for == "THREAD":
            return
        x, z = new.demand[:2]
        off = min((_off(block, x, z) for block in self.blocks if block.moves), default=0.0)
        assert off < ON_PATH, f"{off} mm off the path in {new.state}, line {new.line}"


def _off(block: Block, x: float, z: float) -> float:
    """Distance of a place from the way of a block, mm, machine coordinates."""
    ax, az, bx, bz = block.x0 + block.offset_x, block.z0 + block.offset_z, block.mx, block.mz
    if block.kind is Kind.ARC:
        cx, cz = block.cx + block.offset_x, block.cz + block.offset_z
        return abs(math.hypot(x - cx, z - cz) - math.hypot(ax - cx, az - cz))
    long = (bx - ax) ** 2 + (bz - az) ** 2
    part = min(max(((x - ax) * (bx - ax) + (z - az) * (bz - az)) / long, 0.0), 1.0) if long else 0.0
    return math.hypot(x - ax - part * (bx - ax), z - az - part * (bz - az))


class ExecutorModel(RuleBasedStateMachine):
    """Rules are steps: a command, a hand at the station, a fault, or time that passes."""

    machine: Machine

    @initialize(program=st.integers(0, len(PROGRAMS) - 1), gear=st.booleans())
    def begin(self, program: int, gear: bool) -> None:
        self.machine = Machine(gear=gear)
        self.hands = self.machine.sim.machine
        SEEN.runs += 1
        self.machine.ready()
        self.machine.load(PROGRAMS[program], TOOLS)
        self.machine.run(0.3)
        self._post(CycleStart())

    # --- time ---------------------------------------------------------------------------------------------

    @rule(ticks=st.integers(1, 30))
    def time_passes(self, ticks: int) -> None:
        self._count("time")
        for _ in range(ticks):
            self.machine.tick()

    @rule(late=st.floats(0.05, 5.0))
    def host_is_late(self, late: float) -> None:
        self._count("late")
        self.machine.tick(round(late, 3))

    # --- the operator -------------------------------------------------------------------------------------

    @rule()
    def presses_start(self) -> None:
        self._start(lambda: self.machine.executor.post(CycleStart()))

    @rule()
    def presses_start_after_reading(self) -> None:
        """As a job is worked: what is off is switched on, what was asked is answered, then both palms."""
        machine = self.machine
        if machine.state is State.FAULT:
            machine.post(Reset())
        if machine.state is State.DISABLED:
            machine.post(EnableDrives())
        if machine.shot.interrupted is not None:
            machine.confirm()
        machine.run(0.4)
        self._start(lambda: machine.executor.post(CycleStart()))
        machine.run(0.2)

    @rule(late=st.floats(0.6, 3.0), jogs=st.booleans())
    def presses_while_nobody_looks(self, late: float, jogs: bool) -> None:
        """A press that waits in the queue of a stalled control, or an edge of the palms behind the stall."""
        self._count("late press")
        machine = self.machine
        if jogs:
            machine.executor.post(Jog("X", 20.0, 0.3))
            machine.executor.post(CycleStart())
        else:
            self.hands.press_start()
        machine.tick(round(late, 3))
        machine.last_press = machine.clock.now()

    @rule()
    def presses_palms(self) -> None:
        self._start(self.hands.press_start)

    @rule()
    def holds(self) -> None:
        was = self.machine.state
        self._post(FeedHold())
        assert self.machine.state not in MOVES or was not in MOVES or self._stopping()

    def _stopping(self) -> bool:
        return self.machine.state in {State.HOLDING, State.JOG}

    @rule()
    def hold_button(self) -> None:
        self._count("hold button")
        self.hands.press_hold()
        self.machine.run(0.05)
        self.hands.release_hold()
        self.machine.run(0.3)

    @rule(drives=st.booleans())
    def estop_and_back(self, drives: bool) -> None:
        self._count("estop")
        self.hands.press_estop()
        self.machine.tick()
        assert self.machine.state is State.ESTOP
        self.machine.run(1.0)
        self.hands.release_estop()
        self.machine.run(0.2)
        if drives:
            self.machine.post(EnableDrives())

    @rule(
        command=st.sampled_from(
            [
                Reset(),
                EnableDrives(),
                EnableDrives(),
                JogStop(),
                WheelOff(),
                SpindleStop(),
                SpindleLimit(500.0),
                SpindleLimit(None),
                ForceOutput("coolant", True),
                ForceOutput("coolant", False),
                ForceOutput("collet", False),
                ForceOutput("collet", True),
                Home(),
                Home("X"),
            ]
        )
    )
    def asks(self, command: Command) -> None:
        self.machine.homed = isinstance(command, Home)
        self._post(command)

    @rule(
        name=st.sampled_from(["single_block", "optional_stop", "cycle_repeat", "no_count"]), on=st.booleans()
    )
    def switches(self, name: str, on: bool) -> None:
        self._post(SetSwitch(name, on))

    @rule(fraction=st.sampled_from([0.0, 0.1, 0.5, 1.0, 1.0, 1.5]))
    def overrides(self, fraction: float) -> None:
        self._post(FeedOverride(fraction))

    @rule(
        command=st.sampled_from(
            [
                Jog("X", 20.0, 0.3),
                Jog("Z", -40.0, 0.3),
                Jog("C", 90.0, 0.2),
                Jog("X", 1e6, 0.3),
                JogStep("X", 0.5, 10.0),
                JogStep("Z", -200.0, 10.0),
                Wheel("X", 0.01, 0.3),
            ]
        )
    )
    def jogs(self, command: Command) -> None:
        self.machine.jogged = True
        self._post(command, moves=True)

    @rule(counts=st.integers(-60, 60))
    def turns_the_handwheel(self, counts: int) -> None:
        self._count("handwheel")
        self.machine.jogged = True
        self.hands.turn_handwheel(counts)
        self.machine.tick()

    @rule(off=st.integers(1, 80))
    def spindle_switch_off_and_auto(self, off: int) -> None:
        self._count("spindle switch")
        self.hands.set_spindle_auto(False)
        self.machine.run(off * TICK)
        self.machine.switched = True
        self.hands.set_spindle_auto(True)
        self.machine.run(0.1)

    @rule(
        which=st.sampled_from(["feed", "spindle"]), fraction=st.sampled_from([0.0, 0.01, 0.3, 0.7, 1.0, 1.0])
    )
    def turns_a_pot(self, which: str, fraction: float) -> None:
        self._count("pot")
        (self.hands.set_feed_pot if which == "feed" else self.hands.set_spindle_pot)(fraction)
        self.machine.tick()

    @rule(line=st.sampled_from(LINES), starts=st.booleans())
    def writes_a_line_of_mdi(self, line: str, starts: bool) -> None:
        """A line typed and proved as the screen does it, started or left standing; then MDI is left."""
        machine = self.machine
        if machine.state is not State.IDLE or not all(machine.shot.homed):
            return
        self._count("mdi")
        job = line_job(machine, line)
        report = prove(job.source, job.setup, machine.machine)
        if report.errors:
            return
        machine.post(Prepare(Starts.LINE, job, proof_of(job, report)))
        machine.run(0.4)
        if starts:
            self._start(lambda: machine.executor.post(CycleStart()))
            machine.run(1.5)
        machine.post(Prepare(Starts.PROGRAM))

    @rule(line=st.integers(1, 9))
    def restarts(self, line: int) -> None:
        """SEARCHTO: the state rebuilt to a line, the way there proved, and both palms."""
        machine = self.machine
        if machine.state is not State.IDLE or machine.shot.alarms or not all(machine.shot.homed):
            return
        self._count("restart")
        job = restart_job(machine, line)
        if job is None:
            return
        report = prove(job.source, job.setup, machine.machine)
        if report.errors:
            return
        machine.post(Prepare(Starts.RESTART, job, proof_of(job, report)))
        machine.run(0.4)
        self._start(lambda: machine.executor.post(CycleStart()))
        machine.run(1.0)

    @rule(program=st.integers(0, len(PROGRAMS) - 1))
    def loads(self, program: int) -> None:
        self._count("load")
        self.machine.load(PROGRAMS[program], TOOLS)

    # --- what breaks --------------------------------------------------------------------------------------

    @rule(ticks=st.integers(5, 90))
    def station_is_silent(self, ticks: int) -> None:
        self._count("silent")
        self.hands.station_silent(True)
        self.machine.run(ticks * TICK)
        self.hands.station_silent(False)
        self.machine.tick()

    @rule(width=st.sampled_from([0.0, 0.0, 0.05, 0.6]))
    def pots_are_noisy(self, width: float) -> None:
        self._count("noise")
        self.hands.pot_noise(width)
        self.machine.tick()

    @rule(fraction=st.sampled_from([0.0, 0.2, 0.6, 1.0, 1.0]))
    def spindle_bogs(self, fraction: float) -> None:
        self._count("bog")
        self.hands.spindle_bog(fraction)
        self.machine.tick()

    @rule(
        what=st.sampled_from(["jam", "encoder", "trip", "spindle", "collet", "coolant", "mend", "mend"]),
        axis=st.sampled_from(["X", "Z"]),
    )
    def breaks(self, what: str, axis: str) -> None:
        self._count(f"breaks: {what}")
        hands = self.hands
        match what:
            case "jam":
                hands.jam(axis, True)
            case "encoder":
                self.machine.blind = True
                hands.encoder_stuck(axis, True)
            case "trip":
                hands.drive_fault(axis)
            case "spindle":
                hands.spindle_fault("overvoltage")
            case "collet":
                hands.set_input("collet_closed", False)
            case "coolant":
                hands.switch_output("coolant", axis == "X")
            case _:
                self._mended()
        self.machine.tick()

    def _mended(self) -> None:
        hands = self.hands
        hands.spindle_fault("")
        hands.spindle_bog(1.0)
        for axis in ("X", "Z"):
            hands.jam(axis, False)
            hands.encoder_stuck(axis, False)
        hands.set_input("collet_closed", True)

    @rule(
        port=st.sampled_from(_PORTS),
        which=st.integers(0, 7),
        times=st.integers(1, 3),
        expected=st.sampled_from([True, True, True, False]),
    )
    def driver_raises(self, port: str, which: int, times: int, expected: bool) -> None:
        self._count("driver raises")
        calls = _CALLS[port]
        call = calls[which % len(calls)]
        error = DriverError("the wire is out; look at it") if expected else RuntimeError("unforeseen")
        self.machine.unexpected = self.machine.unexpected or not expected
        self.machine.broken[port].breaks[call] = (error, times)
        self.machine.tick()
        self.machine.broken[port].breaks.clear()

    # --- no state that cannot be left ---------------------------------------------------------------------

    def teardown(self) -> None:
        if hasattr(self, "machine"):
            self._mend()
            self._make_a_part()

    def _mend(self) -> None:
        hands = self.hands
        for port in self.machine.broken.values():
            port.breaks.clear()
        hands.station_silent(False)
        hands.pot_noise(0.0)
        self._mended()
        hands.release_hold()
        hands.release_estop()
        hands.set_feed_pot(1.0)
        hands.set_spindle_pot(1.0)
        hands.set_spindle_auto(True)
        self.machine.switched = True
        for _ in range(150):
            self.machine.tick()
        self.machine.post(FeedOverride(1.0))
        for name in ("single_block", "optional_stop", "cycle_repeat", "no_count"):
            self.machine.post(SetSwitch(name, False))

    def _make_a_part(self) -> None:
        machine = self.machine
        for _ in range(8):
            if machine.state is State.IDLE:
                break
            off = machine.state is State.DISABLED and not machine.shot.alarms
            machine.post(EnableDrives() if off else Reset())
            machine.run(2.0)
        assert machine.state is State.IDLE, f"{machine.state} cannot be left: {machine.shot.alarms}"
        if not all(machine.shot.homed):
            machine.homed = True
            machine.post(Home())
            machine.until(State.IDLE, limit=120.0)
        machine.post(Prepare(Starts.PROGRAM), SpindleStop(), ForceOutput("collet", True))
        machine.run(3.0)
        self._back_into_the_travel()
        machine.load(SAFE)
        if machine.shot.interrupted is not None:
            machine.confirm()
        machine.run(0.5)
        parts = machine.shot.parts
        machine.pressed = True
        machine.post(CycleStart())
        assert not machine.shot.start_refused, machine.shot.start_refused
        for _ in range(3000):
            if machine.state is State.IDLE:
                break
            machine.tick()
        assert machine.shot.parts == parts + 1, machine.shot
        SEEN.parts += 1

    def _back_into_the_travel(self) -> None:
        """Where a blind slide ran over its soft limit: the jog that leads back is allowed."""
        machine = self.machine
        for index, (axis, at) in enumerate(zip(machine.machine.axes, machine.shot.actual, strict=True)):
            low, high = axis.travel or (at, at)
            if low <= at <= high:
                continue
            inward = 20.0 if at < low else -20.0
            for _ in range(200):
                machine.jogged = True
                machine.post(Jog(axis.name, inward, 0.3))
                machine.run(0.2)
                if low + 1.0 < machine.shot.actual[index] < high - 1.0:
                    break
            machine.until(State.IDLE)

    # --- helpers ------------------------------------------------------------------------------------------

    def _count(self, name: str) -> None:
        SEEN.steps += 1
        SEEN.rules[name] += 1

    def _start(self, press: Callable[[], None]) -> None:
        """A start that does nothing says why, unless something moves already."""
        self._count("start")
        machine = self.machine
        old = machine.state
        refused = len(machine.said("refused"))
        starts = self._acted()
        recent = machine.clock.now() - machine.last_press < BOUNCE
        machine.last_press = machine.clock.now()
        machine.pressed = True
        press()
        machine.tick()
        if old not in ACTIVE and machine.state is old and old in CYCLE | {State.IDLE, State.DISABLED}:
            said = len(machine.said("refused")) > refused or self._acted() > starts
            assert said or recent or machine.shot.start_refused, f"{old}: a start says nothing"

    def _acted(self) -> int:
        """How often something was begun or gone on with, as the log has it."""
        return sum(event.kind in {"start", "mdi", "state"} for event in self.machine.events)

    def _post(self, command: Command, *, moves: bool = False) -> None:
        self._count(type(command).__name__)
        machine = self.machine
        machine.pressed = isinstance(command, CycleStart)
        if machine.pressed:
            machine.last_press = machine.clock.now()
        old, told = machine.shot, len(machine.events)
        machine.post(command)
        if moves and machine.state is old.state and machine.state is not State.JOG:
            words = [event.kind for event in machine.events[told:]]
            assert (
                "refused" in words
                or machine.shot.alarms != old.alarms
                or machine.shot.wheel
                or machine.shot.wheel_ended
            ), f"{command} in {old.state} says nothing"
