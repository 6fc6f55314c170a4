"""How fast the part is drawn in space: ``python -m tests.benchmarks.bench_solid_picture``.

The parts are those of ``bench_milled_part``. While a part is rotated, each picture has another direction, and
the size of its pixels adapts as on the screen. A fine picture has one sample for each pixel at first, and
smooth edges at the end. All times are processor times, with the clamping and in ms.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from dataclasses import replace

from core.part.milled_part import MilledPart
from core.part.picture.clamping_bodies import make_clamping_bodies
from core.part.picture.part_scene import PartScene
from core.part.picture.solid_picture import SolidPicture
from core.part.picture.solid_view import SolidView, fit_view, make_coarse_view
from core.part.picture.surface_points import Solid, make_milled_solid, make_turned_solid
from core.part.polar_field import make_field_from_section
from core.part.stock import make_bar_stock
from tests.benchmarks.bench_milled_part import LENGTH, RADIUS, operations, section

SIZES = ((640, 800), (1920, 1080))
FRAMES = 12
SCENE = PartScene(make_clamping_bodies(None, make_bar_stock(2.0 * RADIUS, 0.0, -LENGTH)))


def rotation_ms(solid: Solid, size: tuple[int, int], scene: PartScene, pixel_size: int) -> float:
    """Median time of a coarse picture while the part is rotated by 2 degrees for each picture."""
    picture, taken = SolidPicture(), []
    for count in range(FRAMES):
        view = replace(fitted(size), azimuth_deg=20.0 + 2.0 * count, tilt_deg=30.0 + count)
        coarse = make_coarse_view(view, *size, pixel_size)
        begin = time.process_time()
        picture.draw_picture(solid, *coarse, scene=scene)
        taken.append(time.process_time() - begin)
    return 1000.0 * statistics.median(taken[1:])


def fine_ms(solid: Solid, size: tuple[int, int], scene: PartScene) -> tuple[float, float]:
    """Median times to the first and to the smooth picture, after a picture with coarse pixels."""
    picture, first, last = SolidPicture(), [], []
    for count in range(4):
        view = replace(fitted(size), azimuth_deg=30.0 + count)
        picture.draw_picture(solid, *make_coarse_view(view, *size, 2), scene=scene)
        begin = time.process_time()
        images = picture.refine_picture(solid, view, *size, scene=scene)
        next(images)
        first.append(time.process_time() - begin)
        for _picture in images:
            pass
        last.append(time.process_time() - begin)
    return 1000.0 * statistics.median(first[1:]), 1000.0 * statistics.median(last[1:])


def fitted(size: tuple[int, int]) -> SolidView:
    """The view in which the part fills the picture."""
    scale, center = fit_view(-LENGTH, 0.0, RADIUS, *size, 30.0)
    return SolidView(pixels_per_mm=scale, center_z_mm=center)


def main() -> None:
    """Print the table."""
    edges, low, high = section()
    part = MilledPart(make_field_from_section(edges, low, high))
    for _name, work in operations():
        work(part)
    solids = {"turned": make_turned_solid(edges, low, high), "milled": make_milled_solid(part.field)}
    sys.stdout.write(f"load {os.getloadavg()[0]:.1f}\n")
    sys.stdout.write(
        f"{'part':<10}{'size':<12}{'pixels of 1':>12}{'2':>8}{'3':>8}{'first':>10}{'smooth':>10}\n"
    )
    for name, solid in solids.items():
        for size in SIZES:
            turning = [rotation_ms(solid, size, SCENE, pixel) for pixel in (1, 2, 3, 4)]
            first, smooth = fine_ms(solid, size, SCENE)
            times = "".join(f"{each:>9.0f}" for each in (*turning, first, smooth))
            sys.stdout.write(f"{name:<10}{size[0]:>4} × {size[1]:<5}{times}\n")


if __name__ == "__main__":
    main()
