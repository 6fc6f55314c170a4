"""The HAL backend on the step clock: the real bridge, HAL's servo thread played component by component.

Real processes have trials of their own: ``tests/drivers/hal``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import ClassVar

import resources
from app.compose.backends.hal_backend import create_hal_config
from app.compose.backends.simulated_backend import create_sim_config
from app.compose.machine.machine_files import parse_machine
from core.machine.machine_model import Machine
from core.ports import ALL_UNKNOWN_PARTS
from drivers.hal.hal_machine import HalMachine
from drivers.simulators.hal_simulator import HalSimulator
from drivers.simulators.plant_controls import PlantControls
from drivers.wakeups import ManualClock
from tests.drivers.contract.rig import Fault, Rig
from tests.drivers.contract.world import SimWorld

_HANDS = """
spindle_auto = { at = "in-auto" }
probe = { at = "in-probe" }

[io.analog]
feed_pot = { at = "pot-feed", range = [0, 1.5] }
spindle_pot = { at = "pot-spindle", switch = "spindle_auto" }

[m_codes]"""
_HOMED = "absolute = false\nhome = { method = 21, speed = 20, latch = 6, order = 1 }\n"


_ORIENT = """[hal.spindle]
orient = "orient.0.enable"
orient_angle = "orient.0.angle"
orient_mode = "orient.0.mode"
is_oriented = "near.0.out"
"""


def hal_text(*, homing: bool = False, lamps: str = "", orients: bool = False) -> str:
    """The machine file of the shipped lathe with an operator station of its own; with ``homing`` its Z only
    counts.

    ``lamps``: lines of [io.out] besides its own. ``orients``: HAL brings its spindle to an angle.
    """
    text = resources.read_machine_file("gt75-hal.toml").replace("\n[m_codes]", _HANDS, 1)
    text = text.replace('enable = "x-motor.sel"', 'enable = "x-motor.sel"\nfault = "x-fault"')
    text = text.replace(
        'enable = "z-motor.sel"', 'enable = "z-motor.sel"\nfault = "z-fault"\nhome = "z-home"'
    )
    text = text.replace("two_hand_start = false", "two_hand_start = true")
    text = text.replace("\ncoolant = ", f"\n{lamps}coolant = ", 1)
    if orients:
        text = text.replace("[spindle]\n", "[spindle]\noriented = true\norient_rpm = 100\n", 1)
        text = text.replace("[hal.spindle]\n", _ORIENT, 1)
    if homing:
        head, z = text.split("[axis.Z]")
        text = f"{head}[axis.Z]{z.replace('absolute = true', _HOMED, 1)}"
    return text


def hal_machine(*, homing: bool = False, lamps: str = "", orients: bool = False) -> Machine:
    """The machine of that file."""
    return parse_machine(hal_text(homing=homing, lamps=lamps, orients=orients), "gt75-hal.toml")


_GONE = Fault(told=0.05, rests=0.5, code="hal-bridge", unknown=ALL_UNKNOWN_PARTS)


class Hal(Rig):
    """Bridge and servo thread, with the driver in the loop that owns them."""

    faults: ClassVar[Mapping[str, Fault]] = {
        "drive fault": Fault(told=0.03, rests=0.1, code="axis", names="the X axis"),
        "following error": Fault(told=0.08, rests=0.2, code="following", names="X: "),
        "dead reader": _GONE,
        "silence": Fault(0.2, 0.6, "hal-silent", "0.1", unknown=ALL_UNKNOWN_PARTS),
        "node reboot": Fault(told=0.35, rests=0.2, code="hal-thread", unknown=ALL_UNKNOWN_PARTS),
        "cable out": Fault(told=0.05, rests=0.2, code="hal-board", unknown=ALL_UNKNOWN_PARTS),
        "garbage": replace(_GONE, code="hal-silent", names="packet"),
    }
    harmless: ClassVar[tuple[str, ...]] = ("late answers",)
    missing: ClassVar[Mapping[str, str]] = {
        "bus-off": "a socket pair has no such state",
        "two masters": "LinuxCNC refuses a second session of HAL",
        "blocks": "its motion is planned here",
        "outputs told": "an output of HAL has one writer",
        "station": "its buttons are pins of HAL; with the bridge's silence all are silent",
    }
    hold = 0.15

    def __init__(self, *, homing: bool = False, lamps: str = "", orients: bool = False) -> None:
        self.machine = hal_machine(homing=homing, lamps=lamps, orients=orients)
        self.clock = ManualClock()
        config = create_hal_config(self.machine)
        self.far = HalSimulator(config, create_sim_config(self.machine), self.clock)
        self.driver = HalMachine(config, self.clock, self.far.restart_bridge, self.far.plant.advance)
        self.ports = self.driver.ports
        self.world = SimWorld(self.far.plant_controls, lambda: self.far.plant.terminals.output_states)

    def alone(self, dt: float) -> None:
        """Two rounds of the loop that owns the bridge."""
        for _ in range(2):
            self.clock.advance(dt / 2)
            self.far.plant.advance()
            self.driver.run_cycle()

    @property
    def slides(self) -> PlantControls:
        """Behind HAL."""
        return self.far.plant_controls

    def acts(self) -> Mapping[str, Callable[[], None]]:
        """What becomes of its processes."""
        far = self.far
        return {
            "drive fault": lambda: far.plant_controls.drive_fault("X"),
            "following error": lambda: far.plant_controls.jam("X"),
            "dead reader": lambda: setattr(far, "is_bridge_killed", True),
            "silence": lambda: setattr(far, "is_bridge_suspended", True),
            "node reboot": lambda: setattr(far, "is_thread_stopped", True),
            "cable out": lambda: setattr(far, "is_cable_disconnected", True),
            "garbage": lambda: setattr(far, "has_invalid_packets", True),
            "late answers": lambda: setattr(far, "delayed_report_count", 4),
        }

    def mend(self) -> None:
        """The slide is free, the processes go on."""
        self.far.plant_controls.jam("X", False)
        self.far.plant.faulty_axes.clear()
        self.far.is_bridge_suspended = self.far.is_thread_stopped = self.far.has_invalid_packets = (
            self.far.is_cable_disconnected
        ) = False

    def close(self) -> None:
        """Both ends."""
        self.driver.close()
