"""Five drives on one bus: nothing in the driver counts axes."""

from __future__ import annotations

import re

import numpy as np
import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from core.machine.machine_model import Machine
from core.ports import MotionSegments
from tests.drivers.canopen.bench import CanBench

BUS = """
[canopen]
interface = "virtual"
channel = "mill"
mode = "pvt"
drive = "copley"
[canopen.nodes]
X = { id = 1 }
Y = { id = 2 }
Z = { id = 3 }
A = { id = 4 }
C = { id = 5 }
spindle = { id = 6 }
io = { id = 10, profile = 401 }
"""


def mill() -> Machine:
    """The shipped table mill with CiA 402 drives instead of simulated ones."""
    text = resources.read_machine_file("ac-table-mill.toml").replace('backend = "sim"', 'backend = "canopen"')
    text = text.replace("commit_ms = 30", "commit_ms = 140").replace(
        "low_water_ms = 80", "low_water_ms = 200"
    )
    text = text.replace("lease_ms = 60", "lease_ms = 150").replace("clearance = 40.0", "clearance = 60.0")
    text = text.replace("[spindle]", '[spindle]\ndriver = "cia402"', 1).replace(
        "oriented = true", "oriented = false"
    )
    numbers = iter(range(64))

    def terminal(match: re.Match[str]) -> str:
        number = next(numbers)
        index = "6200" if match[1].startswith("OUT") else "6000"
        return f'at = "401.{index}.{1 + number // 8}.{number % 8}"'

    text = re.sub(r'at = "([^"]+)"', terminal, text)
    return parse_machine(text + BUS, "mill.toml")


def test_five_axes_move_along_one_line_and_arrive_together() -> None:
    bench = CanBench(mill())
    axes = bench.machine.axes
    assert axes.axes == ("X", "Y", "Z", "A", "C")
    axes.enable(True)
    at = bench.clock.now() + 0.15
    speed = np.array([40.0, -30.0, -20.0, 10.0, 25.0])
    up, cruise = 0.1, 0.4
    p = np.zeros((3, 5))
    p[1], p[2] = 0.5 * speed * up, 0.5 * speed * up + speed * cruise
    v = np.vstack([np.zeros(5), speed, speed])
    a = np.vstack([speed / up, np.zeros(5), -speed / up])
    axes.splice(MotionSegments(at + np.array([0.0, up, up + cruise]), np.array([up, cruise, up]), p, v, a))
    worst = 0.0
    for _ in range(200):
        bench.tick()
        way = np.array([bench.peers.plant.axis_drives[name].setpoint_position for name in axes.axes]) / speed
        worst = max(worst, float(np.ptp(way)))
    assert worst < 0.001 / 10.0  # a count of the slowest axis, in seconds of its way
    assert axes.sample().fault == ""
    assert axes.sample().actual == pytest.approx(tuple(speed * (up + cruise)), abs=0.002)
    bench.close()
