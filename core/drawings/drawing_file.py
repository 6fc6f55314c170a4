"""A drawing file, DXF or SVG by its ending; one that is empty or far too large is not even opened."""

from __future__ import annotations

from pathlib import Path

from core.drawings.drawing import MOST_BYTES, Drawing, DrawingError

ENDINGS = (".dxf", ".svg")


def is_drawing(name: str) -> bool:
    """Whether a file is one by its ending."""
    return name.lower().endswith(ENDINGS)


def read_drawing(path: Path) -> Drawing:
    """The lines and arcs of a drawing. Raises DrawingError with one sentence."""
    if not is_drawing(path.name):
        raise DrawingError(f"{path.name} is no drawing: DXF and SVG are read.", "not-a-drawing")
    try:
        size = path.stat().st_size
        if not size:
            raise DrawingError(f"{path.name} is empty: save the drawing anew.", "empty")
        if size > MOST_BYTES:
            raise DrawingError(
                f"{path.name} has {size / 1e6:.0f} MB, {MOST_BYTES / 1e6:.0f} are read: "
                "save the contour of the part alone.",
                "too-large",
            )
        if path.suffix.lower() == ".svg":
            from core.drawings.svg_reader import read_svg

            return read_svg(path)
        from core.drawings.dxf_reader import read_dxf

        return read_dxf(path)
    except OSError as error:
        raise DrawingError(f"{path.name} cannot be read: {error.strerror or error}.", "unreadable") from error
    except MemoryError as error:
        raise DrawingError(
            f"{path.name} needs more memory than is free: close other programs.", "out-of-memory"
        ) from error
