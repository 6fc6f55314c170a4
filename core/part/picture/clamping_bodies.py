"""The chuck, jaws, collet, tailstock and bar around a part, as round bodies and blocks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from enum import IntEnum
from itertools import pairwise
from typing import NamedTuple

from core.part.stock import Clamping, Stock

_BODY_LENGTH_MM = 20.0  # mm of the chuck body that are drawn
_MIN_JAW_LENGTH_MM = 10.0  # mm; a shorter front is the nose of a collet
_JAW_COUNT = 3
_JAW_WIDTH_RATIO = 0.36  # ratio to the radius of the jaws
_FRONT_STEP_RATIO = 0.55  # share of the height of a jaw that its front step has
_CHAMFER_RATIO = 0.04  # ratio to the radius of the chuck
_ASSUMED_CHUCK_RATIO = 2.4  # ratio to the radius of the stock
_ASSUMED_JAW_RATIO = 1.9
_MIN_ASSUMED_RADIUS_MM = 12.0  # mm more than the radius of the stock


class BodyMaterial(IntEnum):
    """The kind of a body, which determines its color."""

    CHUCK = 0
    JAW = 1
    BAR = 2
    TAILSTOCK = 3


class RoundBody(NamedTuple):
    """A cylinder or cone about the Z axis, from ``back_z_mm`` to ``front_z_mm``.

    ``back_radius_mm`` and ``front_radius_mm`` are its radii at both ends.
    """

    back_z_mm: float
    front_z_mm: float
    back_radius_mm: float
    front_radius_mm: float
    material: BodyMaterial


class BlockBody(NamedTuple):
    """A rectangular block on one side of the Z axis, for example a step of a jaw.

    It extends from ``inner_mm`` to ``outer_mm`` from the axis, in the direction of the polar angle
    ``angle_deg`` of the part. ``width_mm`` is its width perpendicular to this direction.
    """

    back_z_mm: float
    front_z_mm: float
    inner_mm: float
    outer_mm: float
    width_mm: float
    angle_deg: float
    material: BodyMaterial = BodyMaterial.JAW


Body = RoundBody | BlockBody


def make_clamping_bodies(clamping: Clamping | None, stock: Stock) -> tuple[Body, ...]:
    """Return the bodies that hold the stock, and the part of the bar inside them.

    If the chuck is not specified, a typical three-jaw chuck is assumed directly after the stock.
    """
    bodies: list[Body] = list(_make_chuck(_find_chuck(clamping, stock), stock))
    if clamping is not None and (tailstock := clamping.tailstock_solid) is not None:
        bodies += [
            RoundBody(back, front, inner, outer, BodyMaterial.TAILSTOCK)
            for (back, inner), (front, outer) in pairwise(tailstock.outside_profile)
        ]
    return tuple(bodies)


def make_stock_bodies(stock: Stock) -> tuple[RoundBody, ...]:
    """Return the uncut stock as cylinders and cones, without its bore."""
    return tuple(
        RoundBody(back, front, inner, outer, BodyMaterial.BAR)
        for (back, inner), (front, outer) in pairwise(stock.outside_profile)
        if front > back
    )


def find_clamping_back_z(clamping: Clamping | None, stock: Stock) -> float:
    """Return the Z of the front of the chuck body, from which a picture should begin."""
    chuck = _find_chuck(clamping, stock)
    return -chuck.stick_out - chuck.jaw_length


def _find_chuck(clamping: Clamping | None, stock: Stock) -> Clamping:
    return clamping if clamping is not None and clamping.chuck_diameter else assume_chuck(stock)


def assume_chuck(stock: Stock) -> Clamping:
    """Return a typical chuck whose jaws end at the back of the stock."""
    radius = stock.max_radius_mm
    chuck, jaws = (
        2.0 * max(ratio * radius, radius + _MIN_ASSUMED_RADIUS_MM * ratio / _ASSUMED_CHUCK_RATIO)
        for ratio in (_ASSUMED_CHUCK_RATIO, _ASSUMED_JAW_RATIO)
    )
    return Clamping(chuck, -stock.back_z_mm, max(0.9 * radius, _MIN_JAW_LENGTH_MM), jaws)


def _make_chuck(clamping: Clamping, stock: Stock) -> Iterator[Body]:
    face, radius = -clamping.stick_out, clamping.chuck_diameter / 2.0
    jaw_radius = (clamping.jaw_diameter or clamping.chuck_diameter) / 2.0
    body, bar_radius = face - clamping.jaw_length, min(stock.max_radius_mm, jaw_radius)
    chamfer = _CHAMFER_RATIO * radius
    yield RoundBody(body - _BODY_LENGTH_MM, body - chamfer, radius, radius, BodyMaterial.CHUCK)
    yield RoundBody(body - chamfer, body, radius, radius - chamfer, BodyMaterial.CHUCK)
    if clamping.jaw_length >= _MIN_JAW_LENGTH_MM:
        yield from _make_jaws(body, face, bar_radius, jaw_radius)
    elif clamping.jaw_length:
        yield RoundBody(body, face, jaw_radius, jaw_radius, BodyMaterial.CHUCK)
    if stock.back_z_mm > body:
        yield RoundBody(body, stock.back_z_mm, bar_radius, bar_radius, BodyMaterial.BAR)


def _make_jaws(body_z_mm: float, face_z_mm: float, inner_mm: float, outer_mm: float) -> Iterator[BlockBody]:
    """Yield the two steps of each jaw. The first jaw points up."""
    middle = 0.5 * (body_z_mm + face_z_mm)
    front_mm = inner_mm + _FRONT_STEP_RATIO * (outer_mm - inner_mm)
    width = _JAW_WIDTH_RATIO * outer_mm
    # A flat jaw touches a round bar only along a line, so it begins slightly inside the bar.
    inside = math.sqrt(max(inner_mm**2 - 0.25 * width**2, 0.0))
    for number in range(_JAW_COUNT):
        angle = 90.0 + number * 360.0 / _JAW_COUNT
        yield BlockBody(body_z_mm, middle, inside, outer_mm, width, angle)
        yield BlockBody(middle, face_z_mm, inside, front_mm, width, angle)
