"""A drawing among the programs, for the pictures."""

from __future__ import annotations

from pathlib import Path

import ezdxf

DRAWING = "spigot.dxf"
# Inches, Z to the right, the axis below: a nose of .5, a taper of 30 degrees, a flange of 1.
NOSE, FLANGE = ((0, 0), (0, 0.25), (-0.5, 0.25)), ((-1, 0.5), (-1.25, 0.5), (-1.25, 0))
OUTLINE = (*NOSE, (-0.7165, 0.375), (-1, 0.375), *FLANGE)
INCH = 1  # $INSUNITS


def put_drawing(folder: Path) -> None:
    """A DXF of one closed outline into the program folder."""
    folder.mkdir(parents=True, exist_ok=True)
    drawing = ezdxf.filemanagement.new()
    drawing.header["$INSUNITS"] = INCH
    drawing.modelspace().add_lwpolyline(OUTLINE)
    drawing.saveas(folder / DRAWING)
