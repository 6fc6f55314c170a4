"""The sample programs prove without a word, on the offsets that come with them."""

from __future__ import annotations

import pytest

from app.compose.machine_files import load_machine, named_machine
from app.compose.machine_setup import setup_for
from app.compose.stored_offsets import read_offsets
from core.language.called_files import with_called_files
from core.language.source import load_source
from core.proving.prove_program import prove
from tests.screen.desks import SAMPLES


@pytest.mark.parametrize("name", ["pinbar.nc", "bushing.nc", "grooves.nc", "knob.nc", "pin.nc"])
def test_sample_proves(name: str) -> None:
    machine = load_machine(None)
    tools, secondary, _ = read_offsets(SAMPLES / "offsets.toml")
    report = prove(load_source(SAMPLES / name), setup_for(machine, tools=tools, secondary=secondary), machine)
    assert report.diagnostics == ()
    assert report.missing_tools == ()


@pytest.mark.parametrize("name", [None, "sinumerik-modulo", "sinumerik-linear"])
def test_the_sinumerik_sample_proves_on_every_lathe(name: str | None) -> None:
    machine = named_machine(name)
    source = with_called_files(load_source(SAMPLES / "ring.mpf"), [SAMPLES])
    report = prove(source, setup_for(machine, tools={}, secondary={}), machine)
    assert report.diagnostics == ()
    assert report.final == pytest.approx((15.0, 30.0, 0.0 if machine.c_modulo else 360.0))
