"""The simulated lathe whose spindle is an inverter on a line, attended by its thread."""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Callable, Mapping
from functools import partial
from typing import ClassVar

import resources
from app.compose.backends.inverter_backend import (
    FaultClearingAxes,
    find_unknown_machine_parts,
    halt_inverter_and_machine,
)
from app.compose.machine.machine_files import parse_machine
from core.ports import UnknownPart
from drivers.inverter.command_monitor import PRESS_ESTOP_TEXT
from drivers.inverter.inverter_control import InverterThread
from drivers.inverter.inverter_spindle import InverterSpindle, create_inverter_control
from tests.drivers.contract.lockstep import LockstepClock
from tests.drivers.contract.rig import Fault
from tests.drivers.contract.simulated import Simulated
from tests.drivers.contract.world import SimWorld
from tests.drivers.inverter.benches import FOLDER, OWN, config, far_end
from tests.drivers.inverter.inverter_simulators import Inverter
from tests.drivers.inverter.wires import BenchWire

_RTU, _NO_WATCH = 2.2, "it has no time-out of its own: a watchdog relay on its run terminal"
_SPINDLE = frozenset({UnknownPart.SPINDLE})
# A second of silence, and the tries under way.
_LOST = Fault(told=_RTU, rests=_RTU + 0.2, code="inverter-silent", names=PRESS_ESTOP_TEXT, unknown=_SPINDLE)
_DISOBEYS = Fault(
    told=1.6, rests=1.8, code="ignores-stop", names="0.00 Hz"
)  # a second, and the looks under way


class InverterWorld(SimWorld):
    """Its spindle is the inverter's motor."""

    inverter: Inverter

    def rpm(self) -> float:
        """By the motor."""
        return self.inverter.rpm

    def press_estop(self) -> None:
        """Its STO goes with the drives'."""
        super().press_estop()
        self.inverter.hold_off(on=True)

    def release_estop(self) -> None:
        """And comes back with it."""
        super().release_estop()
        self.inverter.hold_off(on=False)

    def spindle_ignores_stop(self) -> None:
        """The inverter no longer takes a stop."""
        self.inverter.deaf = True

    def spindle_dies(self) -> None:
        """The motor is overloaded."""
        self.inverter.motor.faults.speed_fraction = 0.3


class OnALine(Simulated):
    """One family; nothing on its wire stops a slide, so the executor has to."""

    family: ClassVar[str]
    faults: ClassVar[Mapping[str, Fault]] = {
        **Simulated.faults,
        "cable out": _LOST,
        "silence": _LOST,
        "garbage": _LOST,
        "answers too late": dataclasses.replace(_LOST, told=2 * _RTU, rests=2 * _RTU + 0.2),
        "node reboot": _DISOBEYS,
        "dead reader": Fault(0.1, 0.2, "inverter-silent", PRESS_ESTOP_TEXT, unknown=_SPINDLE),
        "two masters": dataclasses.replace(_DISOBEYS, names=PRESS_ESTOP_TEXT),
    }
    harmless: ClassVar[tuple[str, ...]] = ("late answers", "noise")
    heals = 2.0  # a port that has gone is tried again each second
    missing: ClassVar[Mapping[str, str]] = {
        "bus-off": "RS-485 has no such state",
        "blocks": Simulated.missing["blocks"],
        "thread": "without an encoder on the spindle no thread is cut",
    }

    def __init__(self, *, homing: bool = False) -> None:
        machine = parse_machine(resources.read_machine_file("gt75-vfd.toml"), "gt75-vfd.toml")
        super().__init__(machine, homing=homing)
        assert isinstance(self.clock, LockstepClock)
        self.inverter = Inverter(self.clock)
        self.wire = BenchWire(far_end(self.family, self.inverter)[1], self.clock)
        self.attendant = create_inverter_control(config(self.family), self.wire.opened, self.clock, FOLDER)
        self.keeper = InverterThread(self.attendant)
        self.attendant.open_and_check_line()
        ports = self.ports
        spindle = InverterSpindle(
            config(self.family),
            self.attendant,
            self.clock,
            is_thread_alive=lambda: self.keeper.is_alive,
            restart_thread=self._revive,
            is_estop_pressed=lambda: ports.station.read_state().estop,
        )
        self.ports = dataclasses.replace(
            ports,
            axes=FaultClearingAxes(ports.axes, spindle.clear_fault),
            spindle=spindle,
            gear=None,
            halt_machine=partial(halt_inverter_and_machine, ports, spindle),
            unknown=partial(find_unknown_machine_parts, ports, spindle),
            spindle_lag=spindle.get_line_delay,
        )
        self.world = InverterWorld(self.hands, ports.io.get_outputs)
        self.world.inverter = self.inverter
        self._hook = threading.excepthook
        self.keeper.start()
        self.clock.attend(self.keeper.thread)

    def make_clock(self) -> LockstepClock:
        """One that the line's thread sleeps on."""
        return LockstepClock()

    def acts(self) -> Mapping[str, Callable[[], None]]:
        """What line and inverter can do."""
        wire = self.wire
        return {
            **super().acts(),
            "cable out": lambda: setattr(wire, "out", True),
            "silence": lambda: setattr(wire, "silent", True),
            "garbage": lambda: setattr(wire, "spoils", True),
            "answers too late": lambda: setattr(wire, "delay", 0.7),
            "node reboot": self.inverter.restart,
            "dead reader": self._kill,
            "two masters": self._another_commands,
            "late answers": lambda: setattr(wire, "delay", 0.1),
            "noise": lambda: setattr(wire, "noise", b"\x00\xff\x01"),
        }

    def mend(self) -> None:
        """The line is as it was."""
        super().mend()
        wire = self.wire
        wire.out = wire.silent = wire.spoils = wire.kills = False
        wire.delay = 0.02

    def close(self) -> None:
        """The thread ends with a last word."""
        assert isinstance(self.clock, LockstepClock)
        self.mend()
        self.clock.release()
        self.keeper.close()
        threading.excepthook = self._hook

    def _kill(self) -> None:
        threading.excepthook = lambda _: None  # its end is what is tried here
        self.wire.kills = True

    def _revive(self) -> None:
        assert isinstance(self.clock, LockstepClock)
        self.keeper.restart()
        self.clock.attend(self.keeper.thread)

    def _another_commands(self) -> None:
        self.inverter.hz = 45.0
        self.inverter.obey(run=True)


class DeltaVfdB(OnALine):
    """Delta VFD-B."""

    family = "delta-vfdb"


class HitachiWj200(OnALine):
    """Hitachi WJ200."""

    family = "hitachi-wj200"


class OwnFile(OnALine):
    """An inverter that only a file of the integrator knows."""

    family = OWN


class HuanyangHy(OnALine):
    """Huanyang HY."""

    family = "huanyang"
    faults: ClassVar[Mapping[str, Fault]] = {
        **OnALine.faults,
        **{
            fault: dataclasses.replace(OnALine.faults[fault], spins=_NO_WATCH)
            for fault in ("cable out", "silence", "dead reader")
        },
    }
