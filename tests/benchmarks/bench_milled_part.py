"""What milling and drawing a part cost: ``python -m tests.benchmarks.bench_milled_part``.

A flange of 60 mm with a thread, a cone, a fillet and a stepped bore, then with a hexagon, a cross hole, a key
slot and six holes round its face: removal operation by operation, and pictures of 720 by 400 pixels.
"""

from __future__ import annotations

import math
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from core.part.milled_part import MilledPart
from core.part.picture.solid_picture import SolidPicture
from core.part.picture.solid_view import SolidView, fit_view, make_coarse_view
from core.part.picture.surface_points import Solid, make_milled_solid, make_turned_solid
from core.part.polar_field import make_field_from_section
from core.part.ray_cuts import FloatArray

FINE, LENGTH, RADIUS = 7500, 60.0, 18.0
WIDTH, HEIGHT, FRAMES = 720, 400, 15
VIEWS = (
    ("from the side", SolidView(azimuth_deg=0.0)),
    ("30 towards the face", SolidView(azimuth_deg=30.0)),
    ("60 towards the face", SolidView(azimuth_deg=60.0)),
    ("a quarter open", SolidView(azimuth_deg=30.0, cut_out_range_deg=(0.0, 90.0))),
)


def section() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Edges, low and high of the turned part, Z-60 to its face."""
    edges = np.linspace(-LENGTH, 0.0, FINE + 1)
    z = 0.5 * (edges[1:] + edges[:-1])
    high = np.select(
        [z < -45.0, z < -30.0, z < -26.0, z < -20.0, z < -17.0], [18.0, 14.0, -16.0 - z, 10.0, 8.0], 10.0
    )
    fillet = 18.0 - np.sqrt(np.maximum(16.0 - (z + 41.0) ** 2, 0.0))
    high = np.where((z > -45.0) & (z < -41.0), fillet, high)
    high = np.where(z > -17.0, 10.0 - 1.2 * np.abs(((z + 17.0) / 1.5) % 1.0 - 0.5), high)
    low = np.select([z < -38.0, z < -35.0, z < -6.0], [0.0, 5.0 * (z + 38.0) / 3.0, 5.0], 7.0)
    return edges, low[None], high[None]


def operations() -> list[tuple[str, Callable[[MilledPart], object]]]:
    """The milling, by name."""

    def hexagon(part: MilledPart) -> None:
        for side in np.radians(np.arange(0.0, 360.0, 60.0)):
            out, along = np.array([np.cos(side), np.sin(side)]), np.array([-np.sin(side), np.cos(side)])
            ends = np.array([16.0 * out - 30.0 * along, 16.0 * out + 30.0 * along])
            part.mill_axial_path(np.column_stack([ends, [-45.0, -45.0]]), 4.0, cutting_length=13.0)

    def face_holes(part: MilledPart) -> None:
        for place in np.radians(np.arange(30.0, 390.0, 60.0)):
            part.mill_axial_path(np.array([[16.0 * math.cos(place), 16.0 * math.sin(place), -70.0]]), 1.2)

    def pocket(part: MilledPart) -> None:
        turn = np.linspace(0.0, 2.0 * math.pi, 200)
        circle = np.column_stack([3.0 * np.cos(turn), 3.0 * np.sin(turn), np.full(200, -58.0)])
        part.mill_axial_path(circle + np.array([12.0, 0.0, 0.0]), 1.5, cutting_length=3.0)

    return [
        ("hexagon by six sides", hexagon),
        ("six holes by an axial drill", face_holes),
        ("round groove in 200 chords", pocket),
        (
            "cross hole",
            lambda part: part.mill_radial_path(np.array([[20.0, -10.0, 0.0], [-20.0, -10.0, 0.0]]), 2.5),
        ),
        (
            "key slot",
            lambda part: part.mill_radial_path(np.array([[15.0, -55.0, 160.0], [15.0, -49.0, 160.0]]), 2.0),
        ),
        (
            "helical slot, a turn",
            lambda part: part.mill_radial_path(np.array([[12.0, -40.0, 0.0], [12.0, -30.0, 360.0]]), 1.0),
        ),
        (
            "rapid past all of it",
            lambda part: part.has_axial_collision(np.array([[25.0, 0.0, 5.0], [25.0, 0.0, -60.0]]), 5.0),
        ),
    ]


def removal(edges: FloatArray, low: FloatArray, high: FloatArray) -> Solid:
    """Print what each operation costs; the part that is left."""
    begin = time.process_time()
    part = MilledPart(make_field_from_section(edges, low, high))
    sys.stdout.write(f"{'rays from the section':<32}{1000 * (time.process_time() - begin):>9.1f}\n")
    for name, work in operations():
        begin = time.process_time()
        work(part)
        sys.stdout.write(f"{name:<32}{1000 * (time.process_time() - begin):>9.1f}\n")
    field = part.field
    layers, columns, rays = field.inner_radii.shape
    size = 2 * field.inner_radii.nbytes / 1e6
    sys.stdout.write(f"{columns} columns, {rays} rays, {layers} layers, {size:.1f} MB\n\n")
    return make_milled_solid(field)


def frame_ms(solid: Solid, view: SolidView, *, changes: bool, coarse: bool) -> float:
    """Median processor time of a picture, ms; ``changes``: the metal changes before each."""
    picture, taken = SolidPicture(), []
    seen = make_coarse_view(view, WIDTH, HEIGHT, 2 if coarse else 1)
    for count in range(FRAMES):
        begin = time.process_time()
        picture.draw_picture(solid, *seen, version=count * changes)
        taken.append(time.process_time() - begin)
    return 1000.0 * statistics.median(taken[1:])


def main() -> None:
    """Print the tables."""
    sys.stdout.write(f"{'removal':<32}{'ms':>9}\n")
    edges, low, high = section()
    milled, turned = removal(edges, low, high), make_turned_solid(edges, low, high)
    heads = ("same", "new metal", "new, coarse")
    sys.stdout.write(f"{'picture, ms':<24}" + "".join(f"{head:>12}" for head in heads * 2) + "\n")
    for name, looked in VIEWS:
        scale, centre = fit_view(-LENGTH, 0.0, RADIUS, WIDTH, HEIGHT, looked.azimuth_deg)
        view = replace(looked, pixels_per_mm=scale, center_z_mm=centre)
        sys.stdout.write(f"{name:<24}")
        for solid in (turned, milled):
            for changes, coarse in ((False, False), (True, False), (True, True)):
                sys.stdout.write(f"{frame_ms(solid, view, changes=changes, coarse=coarse):>12.1f}")
        sys.stdout.write("\n")


if __name__ == "__main__":
    main()
