"""The sample programs prove without a word, on the offsets that come with them."""

from __future__ import annotations

import math

import pytest

from app.compose.machine.machine_files import load_machine, load_named_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.stored_offsets import read_offsets_file
from core.geometry.rotation_frames import add_vectors, apply_matrix
from core.interpreter.dialects import interpret_program
from core.language.called_files import load_called_files
from core.language.diagnostics import Severity
from core.language.source import load_source
from core.proving.prove_program import prove
from tests.screen.desks import SAMPLES


@pytest.mark.parametrize("name", ["pinbar.nc", "bushing.nc", "grooves.nc", "knob.nc", "pin.nc"])
def test_shipped_sample_proves_without_findings(name: str) -> None:
    machine = load_machine(None)
    tools, secondary, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    report = prove(
        load_source(SAMPLES / name),
        create_power_up_setup(machine, tool_offsets=tools, secondary_offsets=secondary),
        machine,
    )
    assert report.diagnostics == ()
    assert report.missing_tool_numbers == ()


@pytest.mark.parametrize("name", [None, "sinumerik-modulo", "sinumerik-linear"])
def test_the_sinumerik_sample_proves_on_every_lathe(name: str | None) -> None:
    machine = load_named_machine(name)
    source = load_called_files(load_source(SAMPLES / "ring.mpf"), [SAMPLES])
    tools, secondary, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    report = prove(
        source, create_power_up_setup(machine, tool_offsets=tools, secondary_offsets=secondary), machine
    )
    # the drill has a motor of its own, which no output of these lathes switches
    assert [(each.line, each.code) for each in report.diagnostics] == [(17, "spindle-off")]
    assert report.final_position == pytest.approx((15.0, 30.0, 0.0 if machine.is_c_axis_modulo else 360.0))


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
def test_sample_of_another_control_proves_on_its_machine(name: str, machine: str) -> None:
    found = load_named_machine(machine)
    tools, secondary, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    source = load_called_files(load_source(SAMPLES / name), [SAMPLES])
    report = prove(
        source, create_power_up_setup(found, tool_offsets=tools, secondary_offsets=secondary), found
    )
    assert [each.message for each in report.diagnostics if each.severity is Severity.ERROR] == []
    assert report.missing_tool_numbers == ()
    assert report.cutting_length_mm > 50.0


def test_every_hole_of_the_nozzle_sample_starts_above_the_stock() -> None:
    """The drill's edge is 2.5 mm beside its tip, and the block's top is Z0: what is rapid stays above, or in
    the hole as deep as it is."""
    found = load_named_machine("ac-table-mill")
    tools, secondary, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    setup = create_power_up_setup(found, tool_offsets=tools, secondary_offsets=secondary)
    deep, holes = math.inf, 0  # along the tool, of the hole under way
    for block in interpret_program(load_source(SAMPLES / "nozzle.h"), setup).generate_blocks():
        if not block.moves or block.swivel is None:
            continue
        system, end = block.swivel.system, block.swivel.end
        _x, _y, above = add_vectors(system.datum, apply_matrix(system.frame, end))
        if not block.rapid:
            holes += deep == math.inf
            deep = min(deep, end[2])
            continue
        if above > 2.5:
            deep = math.inf if block.line == 14 else deep
        else:
            assert end[2] > deep
    assert holes == 6
