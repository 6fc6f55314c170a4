"""Nine complete programs as a shop writes them, with and without described tools and stock."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.part_data import make_part_settings
from app.offsets.offsets_file import read_tool_shapes
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import ClampingModel
from core.part.stock_spec import parse_stock_specification
from core.proving.part_proof import prove_program_and_part
from core.proving.proof_report import PartReport, ProofReport

FOLDER = Path(__file__).parent / "shop_programs"
JOBS: dict[str, dict[str, Any]] = tomllib.loads((FOLDER / "jobs.toml").read_text())
INCH = 25.4
NOSE = 0.0156 * INCH


@cache
def proved(name: str, folder: Path) -> tuple[ProofReport, PartReport]:
    """Prove one of the programs with what its job says, in times without accelerations."""
    job = JOBS[name]
    machine = replace(load_machine(None), clamping=ClampingModel(diameter=3.0 * INCH), tooling_kind="single")
    shapes_file = folder / "tools.toml"
    shapes_file.write_text(job.get("tools", ""))
    shapes = read_tool_shapes(shapes_file) if "tools" in job else {}
    tools = {n: ToolOffset(-12.7, -50.8) for n in range(1, 9)}
    setup = create_power_up_setup(
        machine, tool_offsets=tools, secondary_offsets={1: SecondaryOffset(-NOSE, -NOSE, NOSE)}
    )
    setting = make_part_settings(machine, tools, shapes, 1.7 * INCH if "stock" in job else None)
    if "stock" in job:
        setting = replace(setting, stock=parse_stock_specification(job["stock"]))
    source = ProgramSource(name, (FOLDER / f"{name}.nc").read_text())
    report, part = prove_program_and_part(source, setup, machine, setting, is_ideal=True)
    assert part is not None
    return report, part


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("shop")


def radius_at(part: PartReport, z: float) -> float:
    """Radius of the outside at a Z, inches."""
    assert part.last_piece is not None
    points = part.last_piece.outside_profile[::-1]
    return float(np.interp(z * INCH, [p[0] for p in points], [p[1] for p in points])) / INCH


@pytest.mark.parametrize("name", JOBS)
def test_a_shop_program_has_no_error_and_no_warning(name: str, folder: Path) -> None:
    report, _ = proved(name, folder)
    found = [(d.line, str(d.severity), d.code) for d in report.diagnostics if str(d.severity) != "note"]
    assert found == []


def test_spacer_has_expected_volume(folder: Path) -> None:
    """pi x (.4375² - .22²) x .5 = .22463 in³, less the chamfer: 2 pi x .4275 x .03²/2 = .00121."""
    (piece,) = proved("spacer", folder)[1].parted_pieces
    assert piece.volume_mm3 / INCH**3 == pytest.approx(0.22342, rel=3e-3)


def test_stud_has_its_length_and_diameter(folder: Path) -> None:
    """Parted off at 1.118 by a blade of .118: 1 in long, .497 in thick."""
    (piece,) = proved("stud", folder)[1].parted_pieces
    assert (piece.outside_profile[0][0] - piece.outside_profile[-1][0]) / INCH == pytest.approx(1.0, abs=1e-3)
    assert max(r for _, r in piece.outside_profile) / INCH == pytest.approx(0.2485, abs=1e-3)


def test_bushing_has_expected_volume_and_wall(folder: Path) -> None:
    """pi x (10² - 6.25²) x 16 mm = 3063.1 mm³, with a wall of 3.75 mm."""
    (piece,) = proved("bushing-metric", folder)[1].parted_pieces
    assert piece.volume_mm3 == pytest.approx(3063.1, rel=3e-3)
    assert piece.min_wall_mm == pytest.approx(3.75, abs=0.01)


def test_plug_has_its_through_hole(folder: Path) -> None:
    """.493 less a blade of .093 is .4 in; the hole of .201 goes through."""
    (piece,) = proved("plug", folder)[1].parted_pieces
    assert (piece.outside_profile[0][0] - piece.outside_profile[-1][0]) / INCH == pytest.approx(0.4, abs=1e-3)
    assert piece.bore_profile is not None
    assert min(r for _, r in piece.bore_profile) / INCH == pytest.approx(0.1005, abs=1e-3)


def test_clevis_pin_has_expected_volume(folder: Path) -> None:
    """pi x .245² = .18857 in³, less chamfer .00066 and a hole of pi/4 x .125² x .49 x .992 = .00596."""
    (piece,) = proved("clevis-pin", folder)[1].parted_pieces
    assert piece.volume_mm3 / INCH**3 == pytest.approx(0.18195, rel=4e-3)


def test_rod_end_has_expected_removed_volume_and_cutting_time(folder: Path) -> None:
    """Two flats at 8 mm of r 10: over y the mill of 16 mm reaches 10 + sqrt(64 - y²) deep.

    22 mm at 200 mm/min are 6.6 s each.
    """
    report, part = proved("rod-end-metric", folder)
    y = np.linspace(-6.0, 6.0, 2001)
    flat = float(np.trapezoid((np.sqrt(100.0 - y**2) - 8.0) * (10.0 + np.sqrt(64.0 - y**2)), y))
    assert part.removed_volume_mm3 == pytest.approx(2.0 * flat, rel=0.02)
    fast = (25.4 * 2 + 25.0) / 50.0
    assert report.program_times.cutting_time_s == pytest.approx(13.2 + fast, abs=2.0)


def test_flange_has_its_speed_limit_and_radius(folder: Path) -> None:
    """250 m/min: at the axis G77 limits the spindle to 2800 rpm. pi x 20² x 15 mm are left of the boss."""
    report, part = proved("flange-metric", folder)
    assert report.program_ranges.rpm_range[1] == pytest.approx(2800.0)
    assert radius_at(part, -5.0 / INCH) * INCH == pytest.approx(20.0, abs=0.01)


def test_handle_has_its_taper_and_groove(folder: Path) -> None:
    """The taper rises from .25 at Z-.05 to .3 at Z-.5: .2722 at Z-.25. The groove is .3 deep at Z-.77."""
    _, part = proved("handle", folder)
    assert radius_at(part, -0.25) == pytest.approx(0.2722, abs=5e-4)
    assert radius_at(part, -0.77) == pytest.approx(0.3, abs=5e-4)


def test_pins_have_expected_volume(folder: Path) -> None:
    """Four pins of .4 in, .75 long less a blade of 2 mm: pi x .2² x .6713 = .08436 in³ each."""
    _, part = proved("bar-pins", folder)
    volumes = [piece.volume_mm3 / INCH**3 for piece in part.parted_pieces]
    assert volumes == pytest.approx([0.08436] * 4, rel=5e-3)
