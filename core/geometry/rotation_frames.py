"""Frames of tilted working planes, rotations, vector operations, and planes through three points.

A frame is a rotation matrix, stored by rows. Its columns are the axes X' Y' Z' of the working plane in the
surrounding system. Angles are in degrees.
"""

from __future__ import annotations

import math

from core.message import CodedError

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
X_AXIS: Vector = (1.0, 0.0, 0.0)
Y_AXIS: Vector = (0.0, 1.0, 0.0)
Z_AXIS: Vector = (0.0, 0.0, 1.0)

MIN_VECTOR_LENGTH = 1e-6  # mm, or without a unit; a shorter vector does not define a direction
MIN_SINE = 1e-6  # sine of the angle at the first point, below which three points do not define a plane

_QUARTERS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


class InvalidFrameError(CodedError, ValueError):
    """An error raised if values do not define a plane. ``str()`` returns the reason."""


def compute_exact_cos_sin(degrees: float) -> tuple[float, float]:
    """Return the cosine and the sine of an angle, exact at multiples of 90 degrees.

    With rounded values, a table at 90 degrees would be tilted by 6e-17 rad.
    """
    quarter, rest = divmod(degrees, 90.0)
    if rest == 0.0:
        return _QUARTERS[int(quarter) % 4]
    angle = math.radians(math.fmod(degrees, 360.0))
    return math.cos(angle), math.sin(angle)


def add_vectors(a: Vector, b: Vector) -> Vector:
    """Return the sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def subtract_vectors(a: Vector, b: Vector) -> Vector:
    """Return the difference of two vectors."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def scale_vector(a: Vector, factor: float) -> Vector:
    """Return a vector multiplied by a number."""
    return a[0] * factor, a[1] * factor, a[2] * factor


def compute_dot_product(a: Vector, b: Vector) -> float:
    """Return the scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def compute_cross_product(a: Vector, b: Vector) -> Vector:
    """Return the vector product of two vectors."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def apply_matrix(matrix: Matrix, vector: Vector) -> Vector:
    """Return the product of a matrix and a vector."""
    return (
        compute_dot_product(matrix[0], vector),
        compute_dot_product(matrix[1], vector),
        compute_dot_product(matrix[2], vector),
    )


def transpose_matrix(matrix: Matrix) -> Matrix:
    """Return the transposed matrix, which is the inverse of a rotation."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    return (a, d, g), (b, e, h), (c, f, i)


def multiply_matrices(*factors: Matrix) -> Matrix:
    """Return the product of matrices from left to right, or the identity matrix without factors."""
    made = IDENTITY
    for factor in factors:
        columns = transpose_matrix(factor)
        first, second, third = (
            (
                compute_dot_product(row, columns[0]),
                compute_dot_product(row, columns[1]),
                compute_dot_product(row, columns[2]),
            )
            for row in made
        )
        made = first, second, third
    return made


def make_rotation(axis: Vector, degrees: float) -> Matrix:
    """Return the matrix of a right-handed rotation about a unit vector by an angle (Rodrigues' formula)."""
    x, y, z = axis
    c, s = compute_exact_cos_sin(degrees)
    d = 1.0 - c
    return (
        (c + x * x * d, x * y * d - z * s, x * z * d + y * s),
        (y * x * d + z * s, c + y * y * d, y * z * d - x * s),
        (z * x * d - y * s, z * y * d + x * s, c + z * z * d),
    )


def make_frame_from_points(first: Vector, second: Vector, third: Vector) -> Matrix:
    """Return the frame defined by three points.

    X' points from the first to the second point, and the third point is on the side of +Y'. Only the
    directions matter. Raises InvalidFrameError if two points are equal or all three points are on one line.
    """
    u, v = subtract_vectors(second, first), subtract_vectors(third, first)
    along, aside = math.hypot(*u), math.hypot(*v)
    if along < MIN_VECTOR_LENGTH:
        raise InvalidFrameError("the first and second points are the same", "first-and-second-point-equal")
    if aside < MIN_VECTOR_LENGTH:
        raise InvalidFrameError("the first and third points are the same", "first-and-third-point-equal")
    x = scale_vector(u, 1.0 / along)
    normal = compute_cross_product(x, scale_vector(v, 1.0 / aside))
    sine = math.hypot(*normal)
    if sine < MIN_SINE:
        raise InvalidFrameError("the three points are on one straight line", "points-on-one-line")
    z = scale_vector(normal, 1.0 / sine)
    return transpose_matrix((x, compute_cross_product(z, x), z))


def make_frame_from_spatial_angles(x_angle: float, y_angle: float, z_angle: float) -> Matrix:
    """Return the rotation by spatial angles: about the fixed X axis, then Y, then Z."""
    return multiply_matrices(
        make_rotation(Z_AXIS, z_angle), make_rotation(Y_AXIS, y_angle), make_rotation(X_AXIS, x_angle)
    )


def make_frame_from_euler_angles(precession: float, nutation: float, rotation: float) -> Matrix:
    """Return the rotation by Euler angles: about Z, then about the rotated X', then about the tilted Z'."""
    return multiply_matrices(
        make_rotation(Z_AXIS, precession), make_rotation(X_AXIS, nutation), make_rotation(Z_AXIS, rotation)
    )


def make_frame_from_vectors(base: Vector, normal: Vector) -> Matrix:
    """Return the frame with Z' along ``normal`` and X' along ``base``, made perpendicular to Z'.

    Raises InvalidFrameError if a vector has no length or if the vectors are parallel.
    """
    long, wide = math.hypot(*normal), math.hypot(*base)
    if long < MIN_VECTOR_LENGTH or wide < MIN_VECTOR_LENGTH:
        raise InvalidFrameError("a vector has zero length", "vector-without-length")
    z = scale_vector(normal, 1.0 / long)
    y = compute_cross_product(z, scale_vector(base, 1.0 / wide))
    sine = math.hypot(*y)
    if sine < MIN_SINE:
        raise InvalidFrameError("the two vectors are parallel", "parallel-vectors")
    y = scale_vector(y, 1.0 / sine)
    return transpose_matrix((compute_cross_product(y, z), y, z))


def make_frame_from_projections(first: float, second: float, rotation: float) -> Matrix:
    """Return the frame of a plane from its projected angles ``first`` in ZX and ``second`` in YZ.

    X' is in the plane ZX before the frame is rotated by ``rotation`` about Z'. Angles are measured upward
    from X and from Y. Raises InvalidFrameError if ``first`` or ``second`` is 90 or -90 degrees.
    """
    (c1, s1), (c2, s2) = compute_exact_cos_sin(first), compute_exact_cos_sin(second)
    if min(abs(c1), abs(c2)) < MIN_SINE:
        raise InvalidFrameError("a projection angle is 90 degrees", "projection-angle")
    along, aside = (c1, 0.0, s1), (0.0, c2, s2)
    return multiply_matrices(
        make_frame_from_vectors(along, compute_cross_product(along, aside)), make_rotation(Z_AXIS, rotation)
    )


def compute_z_rotation_deg(frame: Matrix) -> float:
    """Return the rotation about Z of a frame that is not tilted, in degrees from -180 to 180."""
    return math.degrees(math.atan2(frame[1][0] - frame[0][1], frame[0][0] + frame[1][1]))
