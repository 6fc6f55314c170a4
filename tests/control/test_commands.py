"""Commands and hands on their way to the executor: their order, what is too late, and that all can go."""

from __future__ import annotations

import dataclasses
import inspect
import pickle
import threading
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

import resources
from app.compose.control.control_messages import SnapshotMessage
from app.compose.control.control_server import list_watched_thread_names
from app.compose.desk_services import SUPERVISED_THREAD_TEXTS
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import get_control_limits, read_machine
from core.executor import commands
from core.executor.commands import (
    ChangeOffsets,
    Command,
    CycleStart,
    DeselectHandwheel,
    EnableDrives,
    FeedHold,
    LoadJob,
    PrepareCycleStart,
    PreventNextPart,
    Reset,
    SetSwitch,
    StopJog,
    StopSpindle,
)
from core.executor.hand_motion.drive_test import DriveTestMotion, Shape
from core.executor.job import Job, Proof, make_job, start_program_pass
from core.executor.snapshot import LogEvent, MachineState, StartAction
from core.interpreter.dialects import SharedProgram, interpret_mdi_line
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.job_setup import InterpreterSetup, SecondaryOffset, ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from drivers.simulators.plant_controls import PlantControls
from tests.control.bench import SHORT, Bench, control, job_of, until
from tests.executor.rig import Rig
from tests.interrupted import broken_off

OMNITURN = ProgramSource("part.nc", SHORT, Dialect.OMNITURN)
SINUMERIK = ProgramSource("part.mpf", "G90 G94 G71\nG1 X10 Z-5 F100\nM30\n", Dialect.SINUMERIK)
KLARTEXT = ProgramSource(
    "part.h", "0 BEGIN PGM PART MM\n1 L X+10 Y+5 R0 FMAX\n2 M30\n3 END PGM PART MM\n", Dialect.KLARTEXT
)
LINES = {
    "gt75.toml": ProgramSource("MDI", "G90G94G01X1F10", Dialect.OMNITURN),
    "sinumerik-live.toml": ProgramSource("MDI", "G1 X10 F100", Dialect.SINUMERIK),
    "ac-table-mill.toml": ProgramSource("MDI", "L X+10 R0 FMAX", Dialect.KLARTEXT),
}


def machine_of(name: str) -> Machine:
    (file,) = Path(resources.__file__).parent.rglob(name)
    return read_machine(str(file))


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    with control(tmp_path) as made:
        yield made


# --- what goes through the connection -------------------------------------------------------------------


def _values() -> Mapping[str, object]:
    """A value for every field of every command, by the name of its type."""
    job = job_of(SHORT, load_machine())
    proof = Proof(job.digest, ())
    return {
        "Job": job,
        "Job | None": job,
        "Proof": proof,
        "Proof | None": proof,
        "InterruptedJob": broken_off(),
        "str": "X",
        "bool": True,
        "float": 0.5,
        "float | None": 2.5,
        "int": 1,
        "Direction | None": (1.0, 0.0, 0.0),
        "DriveTestMotion": _made(DriveTestMotion),
        "Mapping[int, ToolOffset]": {3: ToolOffset(1.0, 2.0)},
        "Mapping[int, SecondaryOffset]": {4: SecondaryOffset(1.0)},
        "tuple[StartClearance, ...]": (commands.StartClearance(job.digest, (1.0, 2.0, 0.0), 3),),
        "StartClearance | None": commands.StartClearance(job.digest, (1.0, 2.0, 0.0), 3),
        "StartAction": StartAction.MDI_LINE,
    }


def _made(kind: type) -> object:
    """One of these with numbers in it."""
    plain: dict[str, object] = {"str": "X", "float": 1.0, "Shape": Shape.SINE}
    return kind(*(plain.get(str(each.type), (1.0, 2.0)) for each in dataclasses.fields(kind)))


KINDS = [each for each in vars(commands).values() if each in Command.__subclasses__()]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_command_arrives_unchanged(kind: type[Command]) -> None:
    values = _values()
    command = kind(*(values[each.annotation] for each in inspect.signature(kind).parameters.values()))
    arrived = pickle.loads(pickle.dumps(command))
    assert type(arrived) is kind
    assert arrived == command


@pytest.mark.parametrize("source", [OMNITURN, SINUMERIK, KLARTEXT], ids=lambda source: source.name)
def test_job_gives_the_same_blocks_in_both_processes(source: ProgramSource) -> None:
    machine = machine_of("ac-table-mill.toml" if source is KLARTEXT else "gt75.toml")
    job = make_job(source, InterpreterSetup(limits=get_control_limits(machine)))
    arrived: Job = pickle.loads(pickle.dumps(job))
    assert arrived == job
    assert arrived.shared_program.has_same_source(job.shared_program)
    there, here = start_program_pass(arrived, arrived.setup), start_program_pass(job, job.setup)
    assert repr(list(there.block_iterator)) == repr(list(here.block_iterator))
    assert list(there.get_diagnostics()) == list(here.get_diagnostics())


@pytest.mark.parametrize("machine", LINES)
def test_mdi_line_leaves_the_same_state_in_both_processes(machine: str) -> None:
    limits = get_control_limits(machine_of(machine))
    line = interpret_mdi_line(
        LINES[machine],
        InterpreterSetup(begin=PassStart(Checkpoint(ModalState()), is_mdi_line=True), limits=limits),
    )
    list(line.generate_blocks())
    left = line.checkpoint
    arrived = pickle.loads(pickle.dumps(left))
    assert arrived == left
    assert hash(arrived.kept) == hash(left.kept)
    here, there = (
        make_job(LINES[machine], InterpreterSetup(begin=PassStart(each, is_mdi_line=True), limits=limits))
        for each in (left, arrived)
    )
    assert here.digest == there.digest
    again: Job = pickle.loads(pickle.dumps(there))
    blocks, same = (repr(list(start_program_pass(each, each.setup).block_iterator)) for each in (again, here))
    assert blocks == same


def test_states_left_by_two_mdi_lines_are_not_equal() -> None:
    limits = get_control_limits(machine_of("sinumerik-live.toml"))
    setup = InterpreterSetup(begin=PassStart(Checkpoint(ModalState()), is_mdi_line=True), limits=limits)
    first, second = (interpret_mdi_line(LINES["sinumerik-live.toml"], setup) for _ in range(2))
    for line in (first, second):
        list(line.generate_blocks())
    assert first.checkpoint.kept is not None
    assert first.checkpoint.kept != pickle.loads(pickle.dumps(second.checkpoint.kept))
    assert first.checkpoint.kept != None  # noqa: E711  it is compared, not looked for


def test_snapshots_and_events_arrive_unchanged() -> None:
    rig = Rig()
    rig.start(SHORT)
    rig.until(MachineState.IDLE)
    rig.sim.machine.press_estop()
    rig.run(0.2)
    assert pickle.loads(pickle.dumps(rig.shot)) == rig.shot
    arrived: list[LogEvent] = pickle.loads(pickle.dumps(rig.events))
    assert arrived == rig.events
    assert any(event.alarm is not None for event in arrived)
    for kept in rig.notes:
        assert pickle.loads(pickle.dumps(kept)) == kept


def test_every_thread_reported_by_the_control_has_a_name_on_screen() -> None:
    assert {"recorder", "pendant"} < set(list_watched_thread_names()) <= SUPERVISED_THREAD_TEXTS.keys()


def test_shipped_machine_file_reread_is_equal_to_itself_only() -> None:
    files = [file for file in Path(resources.__file__).parent.rglob("*.toml") if file.stem != "offsets"]
    read = [read_machine(str(file)) for file in files]
    assert len(read) > 10
    for file, machine in zip(files, read, strict=True):
        running = pickle.loads(pickle.dumps(machine))
        assert running == read_machine(str(file))
        assert [other for other in read if other == running] == [machine]


# --- their order ------------------------------------------------------------------------------------------


class SlowReading:
    """Programs are read for as long as a test wants."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.begun, self.over = threading.Event(), threading.Event()
        monkeypatch.setattr(SharedProgram, "parse_text", self.read)

    def read(self, _read: object = None) -> None:
        """Begin, and end when the test says so."""
        self.begun.set()
        self.over.wait(30.0)


@pytest.mark.parametrize("stop", [FeedHold(), StopJog(), Reset(), StopSpindle(), DeselectHandwheel()])
def test_a_stop_overtakes_a_program_that_is_being_read(
    bench: Bench, stop: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = bench.screen()
    screen.meet()
    screen.post(EnableDrives())
    bench.until(MachineState.IDLE)
    slow = SlowReading(monkeypatch)
    obeyed = list[Command]()
    post = bench.server.executor.post

    def note(command: Command, at: float | None = None) -> None:
        obeyed.append(command)
        post(command, at)

    monkeypatch.setattr(bench.server.executor, "post", note)
    job = job_of(SHORT, bench.machine)
    screen.post(LoadJob(job, Proof(job.digest, ())))
    assert slow.begun.wait(30.0)
    screen.post(CycleStart())  # asked for before the stop: it is dropped
    screen.post(SetSwitch("optional_stop", True))
    screen.post(stop)
    until(lambda: stop in obeyed)
    assert obeyed == [stop]
    screen.post(CycleStart())  # and this one is not
    slow.over.set()
    until(lambda: len(obeyed) == 4)
    assert [type(each) for each in obeyed] == [type(stop), LoadJob, SetSwitch, CycleStart]


@pytest.mark.parametrize("hand", ["press_hold", "press_estop"])
def test_hold_or_estop_discards_start_commands_sent_before_it(
    bench: Bench, hand: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = bench.screen()
    screen.meet()
    screen.post(EnableDrives())
    bench.until(MachineState.IDLE)
    slow = SlowReading(monkeypatch)
    job = job_of(SHORT, bench.machine)
    screen.post(LoadJob(job, Proof(job.digest, ())))
    assert slow.begun.wait(30.0)
    bench.start(screen, job)
    screen.hand(hand)
    screen.hand("release_hold")
    screen.hand("release_estop")
    screen.hand("set_feed_pot", 0.5)
    until(lambda: bench.shot.feed_override == 0.5)
    slow.over.set()
    until(lambda: bench.shot.program == "part.nc")
    screen.post(SetSwitch("optional_stop", True))
    screen.take(SnapshotMessage, lambda each: each.snapshot.optional_stop)
    assert bench.shot.begun == 0


def test_late_start_command_is_rejected_and_other_late_commands_are_not(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    screen.post(EnableDrives(), late=0.6)
    screen.post(PreventNextPart("WHY"), late=60.0)
    until(lambda: bench.shot.next_barred == "WHY")
    assert bench.shot.state is MachineState.DISABLED
    assert len(screen.events("refused")) == 1


def test_program_text_is_parsed_once_for_all_its_commands(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = bench.screen()
    screen.meet()
    read = list[str]()
    monkeypatch.setattr(SharedProgram, "parse_text", lambda self: read.append(self.source.text))
    job = job_of(SHORT, bench.machine)
    worn = job_of(SHORT, bench.machine, tools={1: ToolOffset(1.0)})
    screen.post(LoadJob(job, Proof(job.digest, ())))
    screen.post(ChangeOffsets(worn, Proof(worn.digest, ())))
    screen.post(PrepareCycleStart(StartAction.PROGRAM))
    screen.post(LoadJob(job_of(SHORT + "\n", bench.machine)))
    screen.post(SetSwitch("optional_stop", True))
    screen.take(SnapshotMessage, lambda each: each.snapshot.optional_stop)
    assert read == [SHORT, SHORT + "\n"]


# --- hands ------------------------------------------------------------------------------------------------


HANDS = ("press_left", "press_right", "release_left", "press_hold", "press_estop", "set_feed_pot")


class Station:
    """Notes what hands do at the station."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.did = list[str]()
        for name in HANDS:
            monkeypatch.setattr(PlantControls, name, lambda *_, name=name: self.did.append(name))


def test_late_palm_presses_are_ignored_and_other_late_actions_are_not(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    station = Station(monkeypatch)
    screen = bench.screen()
    screen.meet()
    for name in HANDS:
        screen.hand(name, *([0.5] if name == "set_feed_pot" else []), late=0.6)
    screen.hand("press_right", late=0.1)
    until(lambda: station.did[-1:] == ["press_right"])
    assert station.did == ["release_left", "press_hold", "press_estop", "set_feed_pot", "press_right"]


def test_station_buttons_of_a_lost_screen_are_released_except_estop(bench: Bench) -> None:
    screen = bench.screen()
    screen.meet()
    screen.hand("press_hold")
    screen.hand("press_left")
    screen.hand("press_estop")
    bench.until(MachineState.ESTOP)
    screen.lose()
    bench.looks(1)
    other = bench.screen()
    assert other.meet().snapshot.state is MachineState.ESTOP
    other.hand("press_right")  # the left one alone would make a start of it
    other.hand("release_estop")
    bench.until(MachineState.DISABLED)
    other.post(EnableDrives())
    bench.until(MachineState.IDLE)
