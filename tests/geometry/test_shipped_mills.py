"""The mills that are shipped, each against a calculation of its own: 4 by 4 matrices made of its file."""

from __future__ import annotations

import math
import random
import tomllib
from typing import Any

import numpy as np
import pytest

import resources
from app.compose.machine.kinematics_chain import build_kinematics
from app.compose.machine.machine_files import load_named_machine
from core.geometry.rotary_axes import Kinematics

MILLS = ("ac-table-mill", "bc-table-mill", "fork-head-mill", "head-table-mill")
_ALONG = {
    "X": (1, 0, 0),
    "Y": (0, 1, 0),
    "Z": (0, 0, 1),
    "-X": (-1, 0, 0),
    "-Y": (0, -1, 0),
    "-Z": (0, 0, -1),
}
_COLUMN = {"A": 0, "B": 1, "C": 2}


def moved(by: Any) -> Any:
    made = np.eye(4)
    made[:3, 3] = by
    return made


def about(direction: str, point: Any, degrees: float) -> Any:
    """A turn about a line: v -> cos v + sin (k x v) + (1 - cos) k (k . v), with the line brought to 0."""
    k = np.array(_ALONG[direction], dtype=float)
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn = np.eye(4)
    turn[:3, :3] = c * np.eye(3) + s * cross + (1 - c) * np.outer(k, k)
    return moved(point) @ turn @ moved([-each for each in point])


def on_workpiece(name: str, angles: dict[str, float], slides: Any, length: float) -> Any:
    """Where the tip is on the workpiece and the tool's direction there; from the file alone."""
    table = tomllib.loads(resources.read_machine_file(f"{name}.toml"))["kinematics"]
    chain = sorted((each for each in table if each in _COLUMN), key=lambda axis: table[axis]["order"])
    to_tip = moved(slides)
    for axis in chain:
        if table[axis]["side"] == "head":
            to_tip = to_tip @ about(table[axis]["direction"], table[axis]["point"], angles[axis])
    carried = np.eye(4)
    for axis in chain:  # the one next to the workpiece turns with all the others
        if table[axis]["side"] == "table":
            carried = about(table[axis]["direction"], table[axis]["point"], -angles[axis]) @ carried
    back = np.linalg.inv(carried)
    tip = back @ to_tip @ np.array([0, 0, -length, 1.0])
    return tip[:3] - np.array(table["origin"]), (back @ to_tip @ np.array([0, 0, 1.0, 0]))[:3]


def shipped(name: str) -> Kinematics:
    found = build_kinematics(load_named_machine(name))
    assert found is not None
    return found


def some_place(
    machine: Kinematics, dice: random.Random
) -> tuple[dict[str, float], tuple[float, float, float]]:
    angles = {
        axis.name: dice.uniform(max(axis.travel_min, -360), min(axis.travel_max, 360))
        for axis in machine.rotary_axes
    }
    x, y, z = (dice.uniform(slide.travel_min, slide.travel_max) for slide in machine.linear_axes)
    return angles, (x, y, z)


@pytest.mark.parametrize("name", MILLS)
def test_points_and_tool_axis_match_the_rotation_matrices(name: str) -> None:
    machine, dice = shipped(name), random.Random(name)
    for _ in range(200):
        (angles, slides), length = some_place(machine, dice), dice.uniform(0, 150)
        tip, along = on_workpiece(name, angles, slides, length)
        assert machine.make_transform(angles, tool_length=length).convert_to_frame_point(
            slides
        ) == pytest.approx(tuple(tip), abs=1e-9)
        frame = machine.compute_tool_frame(angles)
        assert [row[2] for row in frame] == pytest.approx(list(along), abs=1e-12)


@pytest.mark.parametrize("name", MILLS)
def test_other_angle_or_length_gives_another_position(name: str) -> None:
    machine = shipped(name)
    angles = {axis.name: 10.0 for axis in machine.rotary_axes}
    tip, _ = on_workpiece(name, angles, (0.0, 0.0, 0.0), 80.0)
    for wrong, length in (({**angles, "C": 11.0}, 80.0), (angles, 80.1)):
        assert machine.make_transform(wrong, tool_length=length).convert_to_frame_point(
            (0.0, 0.0, 0.0)
        ) != pytest.approx(tuple(tip), abs=1e-3)
