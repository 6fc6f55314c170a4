"""Pictures of the parts of programs, for the guide: ``python -m tests.screen.part_pictures OUT PROGRAM…``.

What was parted off, or else what the chuck holds at the end, is drawn twice: whole and with a quarter taken
out, or from both sides where a live tool has been at it. ``--sheet NAME`` puts all parts on one picture.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QColor, QFont, QImage, QPainter
from PySide6.QtWidgets import QApplication

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.program_proving import get_samples_folder
from app.compose.stored_offsets import read_offsets_file
from app.path.solid_pane_view import find_removed_quarter
from app.screen.screen_theme import FONT_FAMILY, load_fonts
from core.interpreter.shared.job_setup import InterpreterSetup, SecondaryOffset, ToolOffset
from core.language.called_files import load_called_files
from core.language.source import Dialect, ProgramSource, load_source
from core.part.picture.part_scene import PartColors
from core.part.picture.solid_picture import SolidPicture
from core.part.picture.solid_view import SolidView, fit_view
from core.part.picture.surface_points import Solid, make_turned_solid
from core.part.polar_field import DEFAULT_RAYS
from core.part.turned_part import PartedPiece
from core.proving.part_history import PartHistory, StepCollector
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings

WIDE, HIGH, HEAD = 210, 150, 20  # pixels
GROUND, INK = 0xFF0F1623, "#f4f7fb"
WHOLE, OPEN = (35.0, 30.0), (25.0, 35.0)  # azimuth and tilt
MILLED = 120.0  # degrees of C: what a live tool has cut is turned to the viewer
ACROSS = 3  # parts beside each other on a sheet


def main(argv: list[str] | None = None) -> int:
    """Write the pictures; the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.screen.part_pictures", description=__doc__)
    parser.add_argument("out", metavar="OUT", type=Path, help="folder for the PNG files")
    parser.add_argument("programs", metavar="PROGRAM", type=Path, nargs="+")
    parser.add_argument("--sheet", metavar="NAME", help="one picture of all")
    args = parser.parse_args(argv)
    _app = QApplication.instance() or QApplication([sys.argv[0], "-platform", "offscreen"])
    load_fonts()
    drawn = {path.stem: part_image(path) for path in args.programs}
    pictures = (
        {args.sheet: _sheet(drawn)} if args.sheet else {f"part-{name}": each for name, each in drawn.items()}
    )
    for name, image in pictures.items():
        path = args.out / f"{name}.png"
        if not coarsened(image).save(str(path), "PNG", 1):  # type: ignore[call-overload]
            raise OSError(f"{path} cannot be written")
        sys.stdout.write(f"{path}\n")
    return 0


def coarsened(image: QImage) -> QImage:
    """The same with 32 steps of each colour: a smaller file, and hardly a difference to be seen."""
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    pixels = np.frombuffer(image.constBits(), dtype=np.uint32) & np.uint32(0xFFF8F8F8)
    size = image.width(), image.height()
    return QImage(pixels.tobytes(), *size, 4 * size[0], QImage.Format.Format_RGB32).copy()


def part_image(path: Path) -> QImage:
    """The part of a program, whole and open, under its name."""
    solid = part_of(path)
    image = QImage(2 * WIDE, HIGH + HEAD, QImage.Format.Format_RGB32)
    image.fill(GROUND)
    painter = QPainter(image)
    turned = solid.inner_radii.shape[2] != DEFAULT_RAYS
    open_ = SolidView(*OPEN, cut_out_range_deg=find_removed_quarter(OPEN[1]))
    for number, view in enumerate((SolidView(*WHOLE), open_ if turned else SolidView(*WHOLE, MILLED))):
        painter.drawImage(number * WIDE, HEAD, _drawn(solid, view))
    font = QFont(FONT_FAMILY)
    font.setPixelSize(12)
    painter.setFont(font)
    painter.setPen(QColor(INK))
    name = path.stem.replace("-", " ")
    painter.drawText(QRect(8, 0, 2 * WIDE - 8, HEAD), Qt.AlignmentFlag.AlignVCenter, name)
    painter.end()
    return image


def part_of(path: Path) -> Solid:
    """What was parted off last, else what is held at the end."""
    source = load_source(path)
    if source.dialect is Dialect.SINUMERIK:
        source = load_called_files(source, [path.parent])
    setup, machine = _setup(path, source), load_machine(None)
    setting = PartSettings(nose_radii={n: tool.nose_radius for n, tool in setup.tools.items()})
    gathered = StepCollector(setting)
    _, report = prove_program_and_part(source, setup, machine, setting, on_span=gathered.add_span)
    moves = gathered.make_program_steps()
    assert report is not None
    assert moves is not None
    if report.parted_pieces and not report.is_milled:
        return _turned(report.parted_pieces[-1])
    history = PartHistory(moves)
    solid = history.make_solid(history.at(len(history.steps)))
    assert solid is not None, path
    return solid


def _setup(path: Path, source: ProgramSource) -> InterpreterSetup:
    """The offsets of our samples; an example of the manual has all at nought."""
    machine = load_machine(None)
    if path.resolve().parent == get_samples_folder().resolve():
        tools, secondary, zero, *_ = read_offsets_file(get_samples_folder() / "offsets.toml")
        return create_power_up_setup(
            machine, tool_offsets=tools, secondary_offsets=secondary, zero_offsets=zero
        )
    return create_power_up_setup(
        machine,
        tool_offsets={n: ToolOffset() for n in range(1, 33)},
        secondary_offsets={n: SecondaryOffset() for n in range(1, 33)},
    )


def _turned(piece: PartedPiece) -> Solid:
    """What a piece is by its profiles."""
    z, r = np.array(piece.outside_profile).T
    count = 3000
    edges = np.linspace(z.min(), z.max(), count + 1)
    middles = 0.5 * (edges[1:] + edges[:-1])
    order = np.argsort(z, kind="stable")
    high = np.interp(middles, z[order], r[order])
    low = np.zeros(count)
    if piece.bore_profile:
        bore_z, bore_r = np.array(piece.bore_profile).T
        order = np.argsort(bore_z, kind="stable")
        low = np.interp(middles, bore_z[order], bore_r[order], left=0.0, right=0.0)
    return make_turned_solid(edges, low[None], high[None])


def _drawn(solid: Solid, view: SolidView) -> QImage:
    """A part that fills its picture."""
    metal = np.flatnonzero((solid.outer_radii > solid.inner_radii).any(axis=(0, 2)))
    back, front = float(solid.column_edges[metal[0]]), float(solid.column_edges[metal[-1] + 1])
    scale, centre = fit_view(back, front, 1.08 * solid.max_radius_mm, WIDE, HIGH, view.azimuth_deg)
    view = replace(view, pixels_per_mm=scale, center_z_mm=centre)
    painter = SolidPicture(PartColors(background=GROUND))
    image = painter.draw_fine_picture(solid, view, WIDE, HIGH)
    return QImage(image.tobytes(), WIDE, HIGH, 4 * WIDE, QImage.Format.Format_RGB32).copy()


def _sheet(drawn: dict[str, QImage]) -> QImage:
    rows = -(-len(drawn) // ACROSS)
    image = QImage(ACROSS * 2 * WIDE, rows * (HIGH + HEAD), QImage.Format.Format_RGB32)
    image.fill(GROUND)
    painter = QPainter(image)
    for number, each in enumerate(drawn.values()):
        row, column = divmod(number, ACROSS)
        painter.drawImage(column * 2 * WIDE, row * (HIGH + HEAD), each)
    painter.end()
    return image


if __name__ == "__main__":
    sys.exit(main())
