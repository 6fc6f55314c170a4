"""The sample programs prove without a word, on the offsets that come with them."""

from __future__ import annotations

import math

import pytest

from app.compose.machine.machine_files import load_machine, named_machine
from app.compose.machine.machine_setup import setup_for
from app.compose.stored_offsets import read_offsets
from core.geometry.rotation_frames import applied, plus
from core.interpreter.dialects import interpretation
from core.language.called_files import with_called_files
from core.language.diagnostics import Severity
from core.language.source import load_source
from core.proving.prove_program import prove
from tests.screen.desks import SAMPLES


@pytest.mark.parametrize("name", ["pinbar.nc", "bushing.nc", "grooves.nc", "knob.nc", "pin.nc"])
def test_sample_proves(name: str) -> None:
    machine = load_machine(None)
    tools, secondary, *_ = read_offsets(SAMPLES / "offsets.toml")
    report = prove(load_source(SAMPLES / name), setup_for(machine, tools=tools, secondary=secondary), machine)
    assert report.diagnostics == ()
    assert report.missing_tools == ()


@pytest.mark.parametrize("name", [None, "sinumerik-modulo", "sinumerik-linear"])
def test_the_sinumerik_sample_proves_on_every_lathe(name: str | None) -> None:
    machine = named_machine(name)
    source = with_called_files(load_source(SAMPLES / "ring.mpf"), [SAMPLES])
    tools, secondary, *_ = read_offsets(SAMPLES / "offsets.toml")
    report = prove(source, setup_for(machine, tools=tools, secondary=secondary), machine)
    # the drill has a motor of its own, which no output of these lathes switches
    assert [(each.line, each.code) for each in report.diagnostics] == [(17, "spindle-off")]
    assert report.final == pytest.approx((15.0, 30.0, 0.0 if machine.c_modulo else 360.0))


@pytest.mark.parametrize(
    ("name", "machine"),
    [
        ("roof.h", "ac-table-mill"),
        ("plate.h", "ac-table-mill"),
        ("plate.h", "fork-head-mill"),
        ("roof.h", "fork-head-mill"),
        ("nozzle.h", "ac-table-mill"),
        ("nozzle.h", "bc-table-mill"),
        ("nozzle.h", "fork-head-mill"),
        ("nozzle.h", "head-table-mill"),
        ("shaft.mpf", "sinumerik-modulo"),
        ("fitting.mpf", "sinumerik-linear"),
    ],
)
def test_a_sample_of_another_control_proves_on_its_machine(name: str, machine: str) -> None:
    found = named_machine(machine)
    tools, secondary, *_ = read_offsets(SAMPLES / "offsets.toml")
    source = with_called_files(load_source(SAMPLES / name), [SAMPLES])
    report = prove(source, setup_for(found, tools=tools, secondary=secondary), found)
    assert [each.message for each in report.diagnostics if each.severity is Severity.ERROR] == []
    assert report.missing_tools == ()
    assert report.cutting_length > 50.0


def test_no_hole_of_the_nozzle_begins_in_metal() -> None:
    """The drill's edge is 2.5 mm beside its tip, and the block's top is Z0: what is rapid stays above, or in
    the hole as deep as it is."""
    found = named_machine("ac-table-mill")
    tools, secondary, *_ = read_offsets(SAMPLES / "offsets.toml")
    setup = setup_for(found, tools=tools, secondary=secondary)
    deep, holes = math.inf, 0  # along the tool, of the hole under way
    for block in interpretation(load_source(SAMPLES / "nozzle.h"), setup).blocks():
        if not block.moves or block.swivel is None:
            continue
        system, end = block.swivel.system, block.swivel.end
        _x, _y, above = plus(system.datum, applied(system.frame, end))
        if not block.rapid:
            holes += deep == math.inf
            deep = min(deep, end[2])
            continue
        if above > 2.5:
            deep = math.inf if block.line == 14 else deep
        else:
            assert end[2] > deep
    assert holes == 6
