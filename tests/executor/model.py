"""A model of the executor: what an operator does, what breaks and how late the host is, in any order.

The invariants are looked at after every tick, on the step clock. In the end all faults are mended, and the
machine must make a part: no state may be one that cannot be left.
"""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule

from app.compose.program_proving import create_proof
from core.executor.commands import (
    Command,
    CycleStart,
    DeselectHandwheel,
    EnableDrives,
    FeedHold,
    ForceOutput,
    HomeAxes,
    Jog,
    JogByStep,
    PrepareCycleStart,
    Reset,
    SelectHandwheel,
    SetFeedOverride,
    SetSpindleLimit,
    SetSwitch,
    StopJog,
    StopSpindle,
)
from core.executor.snapshot import ACTIVE_STATES, CYCLE_STATES, MachineState, StartAction
from core.interpreter.shared.job_setup import ToolOffset
from core.ports import DriverError
from core.proving.prove_program import prove
from tests.executor.lines import line_job, restart_job
from tests.executor.model_machine import MOVES, PORTS, SEEN, Machine
from tests.executor.rig import TICK

TOOLS = {1: ToolOffset(), 2: ToolOffset(x=1.0, z=-2.0)}
PROGRAMS = (
    "G90G94F300\nX.3Z.3\nX.3\nG01X.4F20\nX.4\nZ.2\nM30\n",
    "G90G94F300\nM03S1000\nM08\nX.5Z.1\nG01X.4Z-.2F5\nX.6\nM09\nM30\n",
    "G90G94F300\nM03S1500\nX.5Z.1\nG95G01Z-.3F.01\nX.7\nG94M05\nM30\n",
    "G90G94F300\nM03S600\nX.5Z.1\nG33X.48Z-.3I.02K.05\nG00X1\nM30\n",
    "G90G94F300\nX.2\nG04F.3\nM00\nX.3\nM01\nX0Z0\nM30\n",
    "G90G94F300\nG01X.2F30\nG02X.2Z-.2I.2K-.1\nX.3Z-.3\nM30\n",
    "G90G94F300\nT1\nX.3Z.2\nT2\nX.3Z.2\nG01Z.1F20\nM30\n",
    "G90G94F300\nM05\nM19\nC90\nG01C180F300\nC180\nM05\nM30\n",
    "G90G94F300\nM03S800\nG04F.2\nM04S800\nG01X.2F10\nM05\nM13\nM12\nM02\n",
    "G90G94F300\nG96S200M03\nX1Z.1\nG94G01X.2F20\nG97\nM30\n",
    "G90G94F300\nM03S900\nX.5Z.1\nLS3\nG91G01X-.05F10\nZ-.1\nG00Z.1\nLF\nG90X.5\nM05\nM30\n",
    "G90G94F300\nM03S1200\nM08\nX.5Z.1\nG01Z-3.F15\nX.6\nM09\nM05\nM30\n",
)
LINES = ("X.2", "Z.2", "G01X.1F20", "M03S500", "M05", "G04F.3", "G91X.05", "G90", "T1", "M08", "M09", "M30")
SAFE = "G90G94F300\nX.05\nX0\nM30\n"
BOUNCE = 0.31  # s in which a second start is the same press
_CALLS = {
    "axes": ("sample", "splice", "demand_at", "horizon", "stop", "enable", "clear_fault", "now"),
    "spindle": ("set_speed", "start_coasting", "speed", "read_angle", "read_fault"),
    "io": ("inputs", "get_outputs", "write", "switch_to_safe_state"),
}


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
        self._count("late", harms=True)
        self.machine.tick(round(late, 3))

    @rule(port=st.sampled_from(PORTS), which=st.integers(0, 7), late=st.floats(0.05, 4.0))
    def host_stands_still_inside_a_tick(self, port: str, which: int, late: float) -> None:
        self._count("stall inside a tick", harms=True)
        calls = _CALLS[port]
        self.machine.broken[port].stalls[calls[which % len(calls)]] = round(late, 3)
        self.machine.tick()
        self.machine.broken[port].stalls.clear()
        # Palms that were let go and pressed again meanwhile are one press to a control that was away.
        self.machine.last_press = self.machine.clock.now()

    # --- the operator -------------------------------------------------------------------------------------

    @rule()
    def presses_start(self) -> None:
        self._start(lambda: self.machine.executor.post(CycleStart()))

    @rule()
    def presses_start_after_reading(self) -> None:
        """As a job is worked: what is off is switched on, what was asked is answered, then both palms."""
        machine = self.machine
        if machine.state is MachineState.FAULT:
            machine.post(Reset())
        if machine.state is MachineState.DISABLED:
            machine.post(EnableDrives())
        if machine.shot.interrupted is not None:
            machine.confirm()
        machine.run(0.4)
        self._start(lambda: machine.executor.post(CycleStart()))
        machine.run(0.2)

    @rule(late=st.floats(0.6, 3.0), jogs=st.booleans())
    def presses_while_nobody_looks(self, late: float, jogs: bool) -> None:
        """A press that waits in the queue of a stalled control, or an edge of the palms behind the stall."""
        self._count("late press", harms=True)
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
        return self.machine.state in {MachineState.STOPPING, MachineState.JOG}

    @rule()
    def hold_button(self) -> None:
        self._count("hold button")
        self.hands.press_hold()
        self.machine.run(0.05)
        self.hands.release_hold()
        self.machine.run(0.3)

    @rule(drives=st.booleans())
    def estop_and_back(self, drives: bool) -> None:
        self._count("estop", harms=True)
        self.hands.press_estop()
        self.machine.tick()
        assert self.machine.state is MachineState.ESTOP
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
                StopJog(),
                DeselectHandwheel(),
                StopSpindle(),
                SetSpindleLimit(500.0),
                SetSpindleLimit(None),
                ForceOutput("coolant", True),
                ForceOutput("coolant", False),
                ForceOutput("collet", False),
                ForceOutput("collet", True),
                HomeAxes(),
                HomeAxes("X"),
            ]
        )
    )
    def asks(self, command: Command) -> None:
        self.machine.homed = isinstance(command, HomeAxes)
        self.machine.harmed |= command == ForceOutput("collet", False)  # no spindle starts then
        self._post(command)

    @rule(
        command=st.sampled_from(
            [StopJog(), DeselectHandwheel(), StopSpindle(), FeedHold(), EnableDrives(), Reset()]
        ),
        ticks=st.integers(1, 200),
        times=st.integers(1, 3),
    )
    def release_comes_late(self, command: Command, ticks: int, times: int) -> None:
        """A key that is let go while the computer is busy: its command comes later, and more than once."""
        self._count("late release")
        self.machine.owed += [(ticks + each, command) for each in range(times)]

    @rule(port=st.sampled_from(["", "", *PORTS]), which=st.integers(0, 7))
    def closes(self, port: str, which: int) -> None:
        """TurnDesk is closed in any state, one call of a driver fails once, and it is started again."""
        self._count("closing", harms=True)
        machine = self.machine
        if port:
            calls = _CALLS[port]
            machine.broken[port].breaks[calls[which % len(calls)]] = (DriverError("the wire is out"), 1)
        machine.close()

    @rule(
        name=st.sampled_from(["single_block", "optional_stop", "cycle_repeat", "no_count"]), on=st.booleans()
    )
    def switches(self, name: str, on: bool) -> None:
        self._post(SetSwitch(name, on))

    @rule(fraction=st.sampled_from([0.0, 0.1, 0.5, 1.0, 1.0, 1.5]))
    def overrides(self, fraction: float) -> None:
        self._post(SetFeedOverride(fraction))

    @rule(
        command=st.sampled_from(
            [
                Jog("X", 20.0, 0.3),
                Jog("Z", -40.0, 0.3),
                Jog("C", 90.0, 0.2),
                Jog("X", 1e6, 0.3),
                JogByStep("X", 0.5, 10.0),
                JogByStep("Z", -200.0, 10.0),
                SelectHandwheel("X", 0.01, 0.3),
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
        self._count("spindle switch", harms=True)  # a thread is lost by it
        self.hands.set_spindle_auto(False)
        self.machine.run(off * TICK)
        self.machine.switched = True
        self.hands.set_spindle_auto(True)
        self.machine.run(0.1)

    @rule(
        which=st.sampled_from(["feed", "spindle"]), fraction=st.sampled_from([0.0, 0.01, 0.3, 0.7, 1.0, 1.0])
    )
    def turns_a_pot(self, which: str, fraction: float) -> None:
        self._count("pot", harms=which == "spindle")
        (self.hands.set_feed_pot if which == "feed" else self.hands.set_spindle_pot)(fraction)
        self.machine.tick()

    @rule(line=st.sampled_from(LINES), starts=st.booleans())
    def writes_a_line_of_mdi(self, line: str, starts: bool) -> None:
        """A line typed and proved as the screen does it, started or left standing; then MDI is left."""
        machine = self.machine
        if machine.state is not MachineState.IDLE or not all(machine.shot.homed):
            return
        self._count("mdi")
        job = line_job(machine, line)
        report = prove(job.source, job.setup, machine.machine)
        if report.errors:
            return
        machine.post(PrepareCycleStart(StartAction.MDI_LINE, job, create_proof(job, report)))
        machine.run(0.4)
        if starts:
            self._start(lambda: machine.executor.post(CycleStart()))
            machine.run(1.5)
        machine.post(PrepareCycleStart(StartAction.PROGRAM))

    @rule(line=st.integers(1, 9))
    def restarts(self, line: int) -> None:
        """SEARCHTO: the state rebuilt to a line, the way there proved, and both palms."""
        machine = self.machine
        if machine.state is not MachineState.IDLE or machine.shot.alarms or not all(machine.shot.homed):
            return
        self._count("restart")
        if not machine.shot.job:
            return  # TurnDesk was closed, and nothing is loaded yet
        job = restart_job(machine, line)
        if job is None:
            return
        report = prove(job.source, job.setup, machine.machine)
        if report.errors:
            return
        machine.post(PrepareCycleStart(StartAction.RESTART, job, create_proof(job, report)))
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
        self._count("silent", harms=True)
        self.hands.station_silent(True)
        self.machine.run(ticks * TICK)
        self.hands.station_silent(False)
        self.machine.tick()

    @rule(width=st.sampled_from([0.0, 0.0, 0.05, 0.6]))
    def pots_are_noisy(self, width: float) -> None:
        self._count("noise", harms=True)
        self.hands.pot_noise(width)
        self.machine.tick()

    @rule(fraction=st.sampled_from([0.0, 0.2, 0.6, 1.0, 1.0]))
    def spindle_bogs(self, fraction: float) -> None:
        self._count("bog", harms=True)
        self.hands.spindle_bog(fraction)
        self.machine.tick()

    @rule(
        what=st.sampled_from(["jam", "encoder", "trip", "spindle", "collet", "coolant", "mend", "mend"]),
        axis=st.sampled_from(["X", "Z"]),
    )
    def breaks(self, what: str, axis: str) -> None:
        self._count(f"breaks: {what}", harms=what != "mend")
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
        port=st.sampled_from(PORTS),
        which=st.integers(0, 7),
        times=st.integers(1, 3),
        expected=st.sampled_from([True, True, True, False]),
    )
    def driver_raises(self, port: str, which: int, times: int, expected: bool) -> None:
        self._count("driver raises", harms=True)
        calls = _CALLS[port]
        call = calls[which % len(calls)]
        error = DriverError("the wire is out; look at it") if expected else RuntimeError("unforeseen")
        self.machine.unexpected = self.machine.unexpected or not expected
        self.machine.broken[port].breaks[call] = (error, times)
        self.machine.tick()
        self.machine.broken[port].breaks.clear()

    @rule(port=st.sampled_from(PORTS), ticks=st.integers(2, 90))
    def port_is_frozen(self, port: str, ticks: int) -> None:
        """A cable is out: the driver goes on telling the last that it heard, and reports that it is old."""
        self._count(f"frozen: {port}", harms=True)
        self.machine.freeze(port)
        for _ in range(ticks):
            self.machine.tick()
        self.machine.thaw()
        self.machine.tick()

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
        self.machine.post(SetFeedOverride(1.0))
        for name in ("single_block", "optional_stop", "cycle_repeat", "no_count"):
            self.machine.post(SetSwitch(name, False))

    def _make_a_part(self) -> None:
        machine = self.machine
        for _ in range(8):
            if machine.state is MachineState.IDLE:
                break
            off = machine.state is MachineState.DISABLED and not machine.shot.alarms
            machine.post(EnableDrives() if off else Reset())
            machine.run(2.0)
        assert machine.state is MachineState.IDLE, f"{machine.state} cannot be left: {machine.shot.alarms}"
        if not all(machine.shot.homed):
            machine.homed = True
            machine.post(HomeAxes())
            machine.until(MachineState.IDLE, limit=120.0)
        machine.post(PrepareCycleStart(StartAction.PROGRAM), StopSpindle(), ForceOutput("collet", True))
        machine.run(3.0)
        self._back_into_the_travel()
        machine.load(SAFE)
        if machine.shot.interrupted is not None:
            machine.confirm()
        machine.run(0.5)
        parts = machine.shot.parts
        machine.pressed = True
        machine.post(CycleStart())
        assert not machine.shot.start_refusal_reason, machine.shot.start_refusal_reason
        for _ in range(3000):
            if machine.state is MachineState.IDLE:
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
            machine.until(MachineState.IDLE)

    # --- helpers ------------------------------------------------------------------------------------------

    def _count(self, name: str, *, harms: bool = False) -> None:
        """``harms``: what the step does is a reason for an alarm."""
        self.machine.harmed = self.machine.harmed or harms
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
        if (
            old not in ACTIVE_STATES
            and machine.state is old
            and old in CYCLE_STATES | {MachineState.IDLE, MachineState.DISABLED}
        ):
            said = len(machine.said("refused")) > refused or self._acted() > starts
            assert said or recent or machine.shot.start_refusal_reason, f"{old}: a start says nothing"

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
        if moves and machine.state is old.state and machine.state is not MachineState.JOG:
            words = [event.kind for event in machine.events[told:]]
            assert (
                "refused" in words
                or machine.shot.alarms != old.alarms
                or machine.shot.wheel
                or machine.shot.wheel_ended
            ), f"{command} in {old.state} says nothing"
