"""Edges and isolated points of a solid picture."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.picture.part_scene import SHADES, ImageArray
from core.part.picture.point_projection import DEPTH_STEPS

CodeArray = npt.NDArray[np.int16]
BoolArray = npt.NDArray[np.bool_]
Float32Array = npt.NDArray[np.float32]

FACING_AWAY = -2
"""Code of a pixel whose surface faces away from the viewer; -1 is the code of an empty pixel."""

_STEP_PX = 6.0  # pixels of depth
_HOLE_PX = 4.0  # pixels of depth
_BEND = 0.25  # change of the normal from one pixel to the next
_CONTRAST = 24  # difference of the green channel between two pixels
_DARKNESS = 0.45  # ratio by which an edge is darker than its surface


class PixelImages(NamedTuple):
    """Images (height, width) of a solid.

    - ``codes`` are the color number times 256 plus the brightness, or -1 for an empty pixel.
    - ``depth`` is larger for a nearer pixel, and 0 for an empty pixel.
    - ``right`` and ``above`` are the components of the normals in the picture. They are NaN where a normal
      is not exact.
    """

    codes: CodeArray
    depth: npt.NDArray[np.int32]
    right: Float32Array
    above: Float32Array


def fill_holes(images: PixelImages) -> None:
    """Fill pixels between surface points, and pixels on the rim that face away, from their neighbors.

    A hole is one pixel wide and much deeper than the pixels on both sides of it.
    """
    for turned in (False, True):
        seen = images.depth.T if turned else images.depth
        hole = np.minimum(seen[:-2], seen[2:])
        hole -= seen[1:-1]
        row, column = np.nonzero(hole > _HOLE_PX * DEPTH_STEPS)
        for image in images:
            values = image.T if turned else image
            values[row + 1, column] = values[row, column]
    codes = images.codes
    row, column = np.nonzero(codes == FACING_AWAY)
    for down, right in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        own = codes[row, column]
        next_row = np.clip(row + down, 0, len(codes) - 1)
        neighbor = codes[next_row, np.clip(column + right, 0, codes.shape[1] - 1)]
        codes[row, column] = np.where(own == FACING_AWAY, neighbor, own)


def soften_steps(image: ImageArray) -> ImageArray:
    """Return a picture whose outlines are blended with their neighbors.

    This takes much less time than several samples for each pixel, but thin lines become paler.
    """
    channels = image.view(np.uint8).reshape(*image.shape, 4)
    green = channels[..., 1].astype(np.int16)
    stepped = np.zeros(image.shape, np.bool_)
    for steps, marked in ((green, stepped), (green.T, stepped.T)):
        contrast = np.abs(steps[1:] - steps[:-1]) > _CONTRAST
        marked[1:] |= contrast
        marked[:-1] |= contrast
    stepped[[0, -1]] = stepped[:, [0, -1]] = False
    row, column = np.nonzero(stepped)
    total = 4 * channels[row, column].astype(np.uint16)
    for down, right in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        total += channels[row + down, column + right]
    softened = image.copy()
    softened.view(np.uint8).reshape(channels.shape)[row, column] = (total + 4) // 8
    return softened


def draw_edges(images: PixelImages) -> None:
    """Darken the edges of the part: its outline, the corners of its profile, and steps in depth.

    A pixel is on an edge if the normal changes by more than ``_BEND`` from it to the next pixel. It is also
    on an edge if it is the deeper pixel at a step in depth, or if the next pixel is empty.
    """
    edges = np.zeros(images.codes.shape, np.bool_)
    codes, depth, right, above = images
    _mark_edges(edges, codes < 0, depth, right, above)
    _mark_edges(edges.T, codes.T < 0, depth.T, right.T, above.T)
    edges &= codes >= 0
    own = codes[edges]
    level = own & (SHADES - 1)
    codes[edges] = own - (level * _DARKNESS).astype(np.int16)


def _mark_edges(
    found: BoolArray,
    empty: BoolArray,
    depth: npt.NDArray[np.int32],
    right: Float32Array,
    above: Float32Array,
) -> None:
    """Mark the edges between pixels that follow each other along the first axis."""
    _add_bends(found, right, above)
    _add_steps(found, depth)
    found[1:] |= empty[:-1]
    found[:-1] |= empty[1:]


def _add_bends(found: BoolArray, right: Float32Array, above: Float32Array) -> None:
    """Mark each pixel at which the normal changes, unless only one pixel has a different normal."""
    bend = np.abs(right[1:] - right[:-1])
    bend += np.abs(above[1:] - above[:-1])
    first, other = np.nonzero(bend > _BEND)
    before, after = np.maximum(first - 1, 0), np.minimum(first + 2, len(right) - 1)
    remains = np.abs(right[after, other] - right[before, other])
    remains += np.abs(above[after, other] - above[before, other])
    lasting = remains > _BEND
    found[first[lasting], other[lasting]] = True


def _add_steps(found: BoolArray, depth: npt.NDArray[np.int32]) -> None:
    """Mark each pixel that is deeper than the mean of its two neighbors by more than ``_STEP_PX``."""
    sunk = depth[:-2] + depth[2:]
    sunk -= 2 * depth[1:-1]
    found[1:-1] |= sunk > _STEP_PX * DEPTH_STEPS
