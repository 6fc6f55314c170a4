"""A controller that plans by itself: the grblHAL simulator at the other end of a wire that can break."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from typing import ClassVar

from app.compose.backends.grblhal_backend import create_grblhal_config
from core.machine.machine_model import Machine
from core.ports import ALL_UNKNOWN_PARTS
from drivers.grblhal.grblhal_machine import GrblMachine
from drivers.operator_station import OnScreenStation
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.simulators.spindle_motor import SpindleMotor
from drivers.wakeups import ManualClock
from tests.drivers.contract.rig import Fault, Rig
from tests.drivers.contract.world import Readings
from tests.drivers.grblhal.bench import LoopWire, grbl_machine, quirky

# It ends what it has: 0.4 s beyond the piece of 0.2 s under way, and the ramp.
_ALONE = "the wire is gone, and the controller has no watch over its host"
HOMING = (
    (
        "absolute = true                 # false",
        "home = { order = 2, speed = 60 }\nabsolute = false  # false",
    ),
    ("absolute = true\n\n[axis.C]", "absolute = false\nhome = { order = 1, speed = 60 }\n\n[axis.C]"),
)


class LateWire(LoopWire):
    """Its bytes take ``late`` seconds to come back."""

    late = 0.0

    def __init__(self, firmware: GrblFirmware) -> None:
        super().__init__(firmware)
        self._coming: deque[tuple[float, bytes]] = deque()

    def read(self) -> bytes:
        now = self.firmware.clock.now()
        self._coming.append((now + self.late, super().read()))
        come = b""
        while self._coming and self._coming[0][0] <= now:
            come += self._coming.popleft()[1]
        return come


class GrblWorld:
    """What hangs on the controller; the buttons are those of the screen."""

    def __init__(self, machine: Machine, peer: GrblFirmware, panel: OnScreenStation) -> None:
        self._machine, self._peer, self._panel = machine, peer, panel
        self._by_hand = False  # somebody has opened the collet
        self.press_hold, self.release_hold = panel.press_hold, panel.release_hold
        self.set_feed_pot, self.set_spindle_auto = panel.set_feed_pot, panel.set_spindle_auto

    def place(self) -> tuple[float, float]:
        """X and Z."""
        self._peer.advance()
        return self._peer.motion.position

    def rpm(self) -> float:
        """By the motor."""
        self._peer.advance()
        return self._peer.spindle.speed

    def outputs(self) -> Readings:
        """By the names of the machine file."""
        return {
            name: self._peer.output_states.get(out.terminal, name == "collet")
            for name, out in self._machine.outputs.items()
        }

    def set_input(self, name: str, on: bool, /) -> None:
        """A pin of the report, or an auxiliary input."""
        wired = self._machine.inputs[name]
        if wired.terminal.startswith("pn."):
            letter = wired.terminal.removeprefix("pn.")
            active = on is not wired.is_active_low
            self._peer.active_pins = self._peer.active_pins.replace(letter, "") + (letter if active else "")
            if letter == "D":  # the firmware stops by itself
                self._peer.is_door_open = active
        else:
            self._peer.auxiliary_inputs[int(wired.terminal.removeprefix("in."))] = (
                on is not wired.is_active_low
            )

    def press_start(self) -> None:
        """Both palms on the screen."""
        self._panel.press_left()
        self._panel.press_right()
        self._panel.release_left()
        self._panel.release_right()

    @property
    def _motor(self) -> SpindleMotor:
        assert isinstance(self._peer.spindle, SpindleMotor)
        return self._peer.spindle

    def press_estop(self) -> None:
        """Its pin, its alarm, and the relay of the spindle."""
        self.set_input("estop", True)
        self._peer.command_spindle_speed(0.0)
        self._peer.output_states.update(flood=False, mist=False)
        self._peer.raise_alarm(10)
        self._motor.remove_power(self._peer.clock.now())

    def release_estop(self) -> None:
        """Free."""
        self.set_input("estop", False)

    def open_collet(self) -> None:
        """Its switch."""
        self._by_hand = True

    def follow(self) -> None:
        """The collet's switch follows its valve, which is closed until it is told otherwise."""
        closed = self._peer.output_states.get(self._machine.outputs["collet"].terminal, True)
        self.set_input("collet_closed", closed and not self._by_hand)

    def silence_station(self) -> None:
        """There is none that could."""
        raise NotImplementedError

    def spindle_ignores_stop(self) -> None:
        """Its inverter no longer obeys."""
        self._motor.faults.is_stop_ignored = True

    def spindle_dies(self) -> None:
        """The belt slips."""
        self._motor.faults.speed_fraction = 0.3


class Grblhal(Rig):
    """On an in-memory wire."""

    faults: ClassVar[Mapping[str, Fault]] = {
        "drive fault": Fault(told=0.02, rests=0.02, code="axis", names="ALARM:17", homeless=True),
        "alarm": Fault(told=0.02, rests=0.02, code="controller-alarm", names="ALARM:14"),
        "cable out": Fault(
            0.02,
            0.9,
            "controller-lost",
            spins=_ALONE,
            flows=_ALONE,
            unknown=ALL_UNKNOWN_PARTS,
        ),
        "silence": Fault(told=1.4, rests=2.2, code="controller-silent", unknown=ALL_UNKNOWN_PARTS),
        "garbage": Fault(told=0.15, rests=0.3, code="controller-silent", names="k' "),
        "node reboot": Fault(told=0.15, rests=0.1, code="position-lost", names="ALARM:3", homeless=True),
        "two masters": Fault(told=0.15, rests=0.3, code="controller-silent", names="'ok'"),
    }
    harmless: ClassVar[tuple[str, ...]] = ("late answers",)
    missing: ClassVar[Mapping[str, str]] = {
        "bus-off": "a serial line and a TCP connection have no such state",
        "dead reader": "there is no reading thread: the executor's look reads the wire",
        "home in E-stop": "the controller's own word counts: it knows whether it has lost steps",
        "station": "its buttons are on the screen of this program: there is no wire",
        "slides": "nobody looks at its steps: a controller without encoders reports what it counts",
        "setpoints": "the controller plans by itself and takes blocks",
    }
    hold = 0.25
    sees_output = 2.5  # it tells its accessories in every twentieth report
    kept_in_estop: ClassVar[Mapping[str, str]] = {
        "catcher": "a controller in alarm takes no M65 before Reset"
    }
    world: GrblWorld

    def __init__(self, *, homing: bool = False) -> None:
        estop = 'estop = { at = "pn.E" }'
        probe = (estop, 'probe = { at = "pn.P" }\n' + estop)
        self.machine = grbl_machine(probe, *(HOMING if homing else ()))
        self.clock = ManualClock()
        self.peer = GrblFirmware(self.clock, quirky(homing=homing))
        self.wire = LateWire(self.peer)
        self.driver = GrblMachine(create_grblhal_config(self.machine), self.clock, self.wire)
        self.ports = self.driver.ports
        self.world = GrblWorld(self.machine, self.peer, self.driver.on_screen_station)

    def alone(self, dt: float) -> None:
        """The controller is brought up to its clock by whoever looks."""
        self.clock.advance(dt)
        self.world.follow()
        self.peer.advance()

    def acts(self) -> Mapping[str, Callable[[], None]]:
        """What wire and controller can do."""
        return {
            "drive fault": self._motor_fault,
            "alarm": lambda: self.peer.raise_alarm(14),
            "cable out": lambda: setattr(self.wire, "cut", True),
            "silence": lambda: setattr(self.peer.behavior, "sends_nothing", True),
            "garbage": lambda: self.peer.send_text("o*\\xffk\r\n"),
            "node reboot": self.peer.reset,
            "two masters": lambda: self.peer.receive_bytes(b"G8\n"),
            "late answers": lambda: setattr(self.wire, "late", 0.15),
        }

    def switch_output(self, name: str, on: bool) -> None:
        """By a pendant's button, or by the firmware."""
        self.peer.output_states[self.machine.outputs[name].terminal] = on

    def _motor_fault(self) -> None:
        """As its firmware does on this input: all off, then the alarm."""
        self.peer.command_spindle_speed(0.0)
        self.peer.output_states.update(flood=False, mist=False)
        self.peer.raise_alarm(17)

    def mend(self) -> None:
        """It speaks again, its cable is in."""
        self.peer.behavior.sends_nothing = self.wire.cut = False

    def close(self) -> None:
        """Nothing to let go."""
