"""A program of everything, as setpoints and on the simulated lathe: C and slides begin and end together."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import pytest

from app.compose.backends.simulated_backend import create_simulation
from app.compose.program_proving import create_proof
from core.executor.commands import CycleStart, EnableDrives, LoadJob
from core.executor.executor import Executor
from core.executor.job import make_job
from core.executor.snapshot import LogEvent, MachineState, Snapshot
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ZeroOffset
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.proving.program_timeline import MotionSpan, Timeline
from core.proving.prove_program import prove
from drivers.wakeups import ManualClock
from tests.sinumerik.lathe import LINEAR, MODULO, setup, source

HOME = (0.0, 0.0, 0.0)
ZERO: Mapping[int, ZeroOffset] = {54: ZeroOffset(0.0, -5.0, 15.0)}

COMMON = """\
; everything that both kinds of C take
N10 G18 G71 G90 G54 DIAMON G94
R1=40 R2=0.2
N20 G0 X=R1 Z2 C0
N30 S800 M3
N40 G1 Z-10 C30 F600 RND=2
N50 X60 C=IC(20)
N60 G3 X80 Z-20 CR=10 C=IC(40)
N70 G2 X100 Z-30 I10 K0 C=IC(-15)
N80 G1 C=IC(45) F3000 ; C alone
N90 G4 S4
N100 G95 G1 Z-40 C=IC(30) F=R2
N110 C=IC(9) F2
N120 G96 S150 LIMS=2000
N130 X60 Z-42 C=IC(12) F0.15
N140 G97 M5
N150 G94
TRANS Z10 C-10
N160 G91 G0 X-4 Z-3 C25
N170 G90 G53 G0 X90 Z0 C=AC(5)
NUT P2
/N180 G0 X200
N190 DIAMOF
N200 G1 X20 Z-6 F1200 CHF=1
N210 Z-16 C=IC(3)
N220 M1
N230 G0 X30 Z20 M30
"""
NUT = ProgramSource("nut.spf", "G91 G1 Z-2 C20 F400\nG90 G0 Z=IC(2)\nM17\n", Dialect.SINUMERIK)
MODULO_ONLY = "N22 C=DC(350)\nN24 C=ACP(10)\nN26 G1 X42 Z1 C=ACN(0) F500\nN28 G0 X=R1 Z2\n"


def program(machine: Machine) -> ProgramSource:
    """What this kind of C takes."""
    text = COMMON
    if machine is MODULO:
        text = text.replace("N30", MODULO_ONLY + "N30", 1)
    return source(text, NUT)


def stretches(machine: Machine) -> tuple[Timeline, list[MotionSpan]]:
    timeline = Timeline.from_program(program(machine), setup(machine, HOME, ZERO), machine)
    return timeline, [each for each in timeline.iter_spans() if isinstance(each, MotionSpan)]


@pytest.mark.parametrize("machine", [MODULO, LINEAR], ids=["modulo", "linear"])
def test_c_and_linear_axes_start_and_end_together_in_every_block(machine: Machine) -> None:
    """At any moment of a straight block C has done the share of its travel that the slides have of theirs."""
    timeline, found = stretches(machine)
    assert timeline.has_errors is False, timeline.diagnostics
    seen = 0
    for stretch in found:
        for block, t0, t1 in stretch.iter_block_times():
            times = np.linspace(t0, t1, 23) - stretch.start_time_s
            at = stretch.planned_chunk.profile.compute_positions(times)
            shares = _shares(block, at)
            for share in shares:
                assert share[0] == pytest.approx(0.0, abs=1e-6)
                assert share[-1] == pytest.approx(1.0, abs=1e-6)
            for one, other in pairwise(shares):
                assert one == pytest.approx(other, abs=1e-6)
            seen += len(shares) > 1
    assert seen > 10


def _shares(block: Block, at: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> list[np.ndarray]:
    """The share of its travel that C, and the slides along their path, have done."""
    shares = []
    if block.c != block.c0:
        shares.append((at[:, 2] - block.c0 - block.modal.offset_c) / (block.c - block.c0))
    if (block.x, block.z) != (block.x0, block.z0):
        shares.append(_along(block, at))
    return shares


def _along(block: Block, at: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> np.ndarray:
    x, z = at[:, 0] - block.offset_x, at[:, 1] - block.offset_z
    if block.kind == "arc":
        angles = np.unwrap(np.arctan2(x - block.cx, z - block.cz))
        turned: np.ndarray = (angles - angles[0]) / (angles[-1] - angles[0])
        return turned
    way = np.array([block.x - block.x0, block.z - block.z0])
    share: np.ndarray = ((x - block.x0) * way[0] + (z - block.z0) * way[1]) / (way @ way)
    return share


@pytest.mark.parametrize("machine", [MODULO, LINEAR], ids=["modulo", "linear"])
def test_setpoints_do_not_jump(machine: Machine) -> None:
    """Also where the modulo axis passes 360: the drives count on."""
    _, found = stretches(machine)
    last = np.array(HOME)
    for stretch in found:
        at = stretch.planned_chunk.profile.compute_positions(
            np.arange(0.0, stretch.planned_chunk.profile.duration_s, 0.001)
        )
        speeds = np.abs(np.diff(np.vstack([last, at]), axis=0)) / 0.001
        assert (speeds <= np.array([axis.max_speed for axis in machine.axes]) * 1.001).all()
        last = stretch.planned_chunk.profile.compute_positions(stretch.planned_chunk.profile.duration_s)[0]


def test_modulo_axis_position_continues_past_360_in_machine() -> None:
    """Past 360 and past 0 its setpoints go on; only what is shown wraps."""
    text = "G0 C=DC(350)\nC=DC(10)\nC=ACP(5)\nC=ACN(4)\nC=IC(-720)"
    timeline = Timeline.from_program(source(text), setup(MODULO, HOME), MODULO)
    reached = [
        block.mc for each in timeline.iter_spans() if isinstance(each, MotionSpan) for block in each.blocks
    ]
    assert reached == pytest.approx([-10, 10, 365, 364, -356])


@pytest.mark.parametrize("machine", [MODULO, LINEAR], ids=["modulo", "linear"])
@pytest.mark.long
def test_program_runs_on_simulated_lathe(machine: Machine) -> None:
    around = setup(machine, HOME, ZERO)
    report = prove(program(machine), around, machine)
    assert report.errors == ()
    job = make_job(program(machine), around)
    clock, events = ManualClock(), list[LogEvent]()
    executor = Executor(machine, create_simulation(machine, clock).ports, events.append)
    end = _run(executor, clock, [EnableDrives(), LoadJob(job, create_proof(job, report)), CycleStart()])
    assert end.alarms == ()
    assert end.parts == 1
    assert end.actual == pytest.approx(report.machine_final_position, abs=0.01)
    assert end.underruns == 0


def _run(executor: Executor, clock: ManualClock, commands: list[object]) -> Snapshot:
    """Each command when the one before has worked, then on to the end of the cycle."""
    for command in commands:
        executor.post(command)  # type: ignore[arg-type]  # commands of three kinds
        for _ in range(20):
            clock.advance(0.01)
            executor.run_tick()
    for _ in range(20_000):
        clock.advance(0.01)
        executor.run_tick()
        if executor.snapshot.state in {MachineState.IDLE, MachineState.FAULT, MachineState.DISABLED}:
            break
    return executor.snapshot


def test_different_subprogram_or_offset_gives_different_job() -> None:
    around = setup(MODULO, HOME, ZERO)
    job = make_job(program(MODULO), around)
    other = ProgramSource(NUT.name, NUT.text + " ", NUT.specified_dialect)
    assert make_job(source(COMMON, NUT), around).digest != make_job(source(COMMON, other), around).digest
    assert make_job(program(MODULO), setup(MODULO, HOME)).digest != job.digest
    assert make_job(program(MODULO), setup(MODULO, HOME, ZERO)).digest == job.digest
