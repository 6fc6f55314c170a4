"""Drawings as targets of fuzzing: what reads them, good samples, and their own damage."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator
from importlib import import_module
from itertools import islice

from core.extras.drawings.drawing import DrawingError
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_placement import (
    ContourSide,
    DrawingPlacement,
    extract_profile,
    find_contours,
    select_axis,
)
from core.extras.drawings.turning_contour import ToolAngleLimits, make_turning_contour
from tests.extras.drawings.hand import chain, dxf
from tests.fuzz.fuzz_target import Target, scratch

NAMES = ("drawing.dxf", "drawing.svg")


def _drawing(ending: str) -> Target:
    import_module(
        f"core.extras.drawings.{ending[1:]}_reader"
    )  # now, while what is loaded is made to tell its branches

    def run(data: bytes) -> Iterable[str]:
        path = scratch() / f"fuzz{ending}"
        path.write_bytes(data)
        drawing = read_drawing(path)
        view = DrawingPlacement(select_axis(drawing, ""), drawing.unit_mm or 1.0)
        for net in islice(find_contours(drawing, view), 4):
            make_turning_contour(extract_profile(drawing, view, net, ContourSide.OUTSIDE), ToolAngleLimits())
        return ()

    def pairs(data: bytes, chance: random.Random) -> bytes:
        """A pair of lines, a code and its value, twice, gone or with another value."""
        lines = data.split(b"\n")
        at = chance.randrange(max(1, len(lines) // 2)) * 2
        what = chance.randrange(3)
        if what == 0:
            del lines[at : at + 2]
        elif what == 1:
            lines[at:at] = lines[at : at + 2 * chance.randrange(1, 8)]
        elif at + 1 < len(lines):
            lines[at + 1] = chance.choice((b"0", b"-1", b"1e308", b"nan", b"x", b"", b"9" * 30))
        return b"\n".join(lines)

    return Target(f"drawing{ending}", lambda: _drawings(ending), run, (DrawingError,), pairs)


_PLAIN_DXF = b"""0
SECTION
2
ENTITIES
0
LINE
8
PART
10
0
20
0
11
0
21
5
0
ARC
8
PART
10
-5
20
5
40
5
50
0
51
90
0
LINE
8
PART
10
-5
20
10
11
-20
21
10
0
ENDSEC
0
EOF
"""


def _drawings(ending: str) -> Iterator[bytes]:
    if ending == ".svg":
        yield (
            b'<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="20mm" viewBox="0 0 40 20">'
            b'<path d="M0 0 L0 5 A5 5 0 0 0 5 10 h10 l5 4 v6 H40 V0"/>'
            b'<rect x="1" y="1" width="4" height="2"/>'
            b'<g transform="rotate(90) scale(2)"><circle cx="4" cy="4" r="2"/></g></svg>'
        )
        return
    yield _PLAIN_DXF
    import_module("ezdxf").options.write_fixed_meta_data_for_testing = True  # the same bytes at every run

    for points in (
        ((0, 0), (0, 5), (-10, 5, 0.4), (-10, 8), (-30, 8), (-30, 0)),
        ((0, 0, 0), (0, 5, 0), (-10, 5, 0), (-12, 4, -0.2), (-20, 9, 0)),
    ):
        yield dxf(scratch() / "seed.dxf", chain(*points)).read_bytes()


TARGETS = (_drawing(".dxf"), _drawing(".svg"))
