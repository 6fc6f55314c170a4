"""A tool is touched off at a tool setter by every driver that has an input: what it finds, what ends it."""

from __future__ import annotations

import dataclasses
import re

import pytest

from core.executor.commands import StopJog, TouchOffTool
from core.executor.snapshot import MachineState, TouchPhase, TouchResult
from core.machine.setter_table import ToolSetterModel
from core.ports import PROBE_INPUT
from tests.drivers.contract.conftest import need
from tests.drivers.contract.control import Control
from tests.drivers.contract.rig import TICK, Rig
from tests.texts import pattern, text

FACE = -6.0  # mm of X: the setter is touched by slides that go beyond, from 0 towards −
SLOW = 0.2  # mm/s
SETTER = ToolSetterModel(
    x=0.0, z=0.0, width=2.0, overtravel=4.0, speed=10.0, slow=SLOW, search=12.0, back_off=1.0
)
LEASE = 0.2
COUNT = 0.003  # mm


class Bench(Control):
    """The executor on a rig with a setter; ``held`` is what the key asks for, ``there``: it stands there."""

    held: TouchOffTool | None = None
    there = True

    def __init__(self, rig: Rig) -> None:
        tables = {**rig.machine.hardware.tables, "setter": SETTER}
        hardware = dataclasses.replace(rig.machine.hardware, tables=tables)
        super().__init__(rig, dataclasses.replace(rig.machine, hardware=hardware))

    def tick(self) -> None:
        if self.held is not None:
            self.executor.post(self.held)
        self.rig.world.set_input(PROBE_INPUT, self.there and self.rig.world.place()[0] < FACE)
        super().tick()

    def touch(self, number: int = 1) -> None:
        self.held = TouchOffTool("X", -1, LEASE, number)
        self.tick()

    def let_go(self) -> None:
        self.held = None
        self.post(StopJog())

    @property
    def touched(self) -> TouchResult:
        assert self.shot.touched is not None, self.events[-3:]
        return self.shot.touched


@pytest.fixture
def bench(shipped: Rig) -> Bench:
    if PROBE_INPUT not in shipped.machine.inputs:
        pytest.skip("its machine file has no input for a tool setter")
    made = Bench(shipped)
    made.ready()
    return made


def test_touch_position_is_found_within_the_stated_uncertainty(bench: Bench) -> None:
    bench.touch()
    bench.until(MachineState.JOG)
    bench.until(MachineState.IDLE, limit=60.0)
    touched = bench.touched
    assert touched.why == ""
    assert touched.touch_position_mm is not None
    # The bench itself makes the input up to a tick late.
    assert touched.touch_position_mm == pytest.approx(FACE, abs=touched.uncertainty_mm + SLOW * TICK + COUNT)
    assert touched.uncertainty_mm <= SLOW * 0.06 / 2 + COUNT / 2
    assert bench.rig.world.place()[0] == pytest.approx(FACE + SETTER.back_off, abs=0.02)
    if bench.rig.ports.touch is not None:
        kept = bench.rig.ports.touch.read_latch()
        assert kept is not None
        assert touched.uncertainty_mm == pytest.approx(
            SLOW * kept.max_delay_s / 2 + bench.rig.machine.find_axis("X").count_size / 2
        )
    assert bench.shot.alarms == ()


@pytest.mark.parametrize("phase", [TouchPhase.SEARCH, TouchPhase.BACK_OFF, TouchPhase.SLOW_TOUCH])
def test_releasing_the_key_stops_the_touch_off(bench: Bench, phase: TouchPhase) -> None:
    bench.touch()
    bench.until_true(lambda shot: shot.touch_phase is phase)
    bench.run(0.1)
    bench.let_go()
    bench.rest(0.6)
    bench.until(MachineState.IDLE)
    assert bench.touched.touch_position_mm is None
    assert text("executor.let-go") in bench.touched.why


def test_lost_screen_stops_the_touch_off(bench: Bench) -> None:
    bench.touch()
    bench.run(0.3)
    bench.held = None
    before = bench.rig.world.place()[0]
    bench.until(MachineState.IDLE)
    assert before - bench.rig.world.place()[0] < 10.0 * (LEASE + 0.5)
    assert bench.touched.touch_position_mm is None


def test_touch_off_without_contact_returns_to_its_start(bench: Bench) -> None:
    bench.there = False
    begin = bench.shot.actual[0]
    bench.touch()
    bench.until(MachineState.JOG)
    bench.until(MachineState.IDLE, limit=30.0)
    assert re.fullmatch(pattern("executor.not-touched"), bench.touched.why)
    assert bench.shot.actual[0] == pytest.approx(begin, abs=0.01)
    assert bench.shot.alarms == ()


def test_touch_off_does_not_start_with_the_setter_input_on(bench: Bench) -> None:
    bench.rig.world.set_input(PROBE_INPUT, True)
    bench.there = False
    for _ in range(30):
        bench.rig.world.set_input(PROBE_INPUT, True)
        Control.tick(bench)
    bench.executor.post(TouchOffTool("X", -1, LEASE, 1))
    Control.tick(bench)
    assert bench.state is MachineState.IDLE
    assert any(text("executor.setter-on") in event.text for event in bench.events if event.kind == "refused")


@pytest.mark.parametrize("fault", ["drive fault", "cable out", "silence"])
def test_fault_ends_the_touch_off(bench: Bench, fault: str) -> None:
    need(bench.rig, fault)
    if fault not in bench.rig.faults:
        pytest.skip(f"its wires cannot have it: {fault}")
    bench.touch()
    bench.run(0.3)
    bench.rig.acts()[fault]()
    bench.until(MachineState.FAULT)
    bench.run(bench.rig.faults[fault].rests)
    assert bench.shot.touch_phase is None
    assert bench.touched.touch_position_mm is None
    assert bench.stands()
