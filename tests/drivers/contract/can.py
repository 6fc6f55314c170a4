"""CiA 402 and 401 peers on a virtual bus: as one loop owns them, and through the driver host's messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import ClassVar

import can

from app.compose.backends.canopen_backend import connect_canopen_machine
from core.machine.machine_model import Machine
from core.ports import ALL_UNKNOWN_PARTS, DriverError, UnknownPart
from drivers.canopen.canopen_machine import CanopenMachine
from drivers.driver_host.host_connection import HostConnection, HostLink, clear_drive_faults
from drivers.driver_host.host_ports import create_host_ports
from drivers.driver_host.host_server import DriverBundle, DriverHost
from drivers.simulators.plant_controls import PlantControls
from drivers.wakeups import ConnectionAttempt
from tests.drivers.canopen.bench import CanBench, can_machine, cyclic
from tests.drivers.contract.rig import Fault, Rig
from tests.drivers.contract.simulated import HOST_FAULTS, HOST_WORDS, BrokenLink
from tests.drivers.contract.world import SimWorld

# Three heartbeats of 100 ms, a round of the bus, and v/a from 120 mm/s.
_SILENT = Fault(told=0.35, rests=0.45, code="drive-silent", names="SYNC")
# The drives miss our heartbeat.
_DEAF = Fault(told=0.05, rests=0.45, code="bus", unknown=ALL_UNKNOWN_PARTS)
_SLIDES, _TERMINALS = frozenset({UnknownPart.AXES}), frozenset({UnknownPart.OUTPUTS, UnknownPart.INPUTS})


class Canopen(Rig):
    """Queued in the drives (PVT)."""

    faults: ClassVar[Mapping[str, Fault]] = {
        "drive fault": Fault(told=0.03, rests=0.1, code="axis", names="X: "),
        "following error": Fault(told=0.08, rests=0.2, code="following", names="EMCY 8611"),
        "cable out": replace(_SILENT, unknown=ALL_UNKNOWN_PARTS),
        "silence": replace(_SILENT, names="Z: ", unknown=_SLIDES),
        "silent terminals": replace(_SILENT, code="io-silent", names="io: ", unknown=_TERMINALS),
        "garbage": replace(_DEAF, names="181"),
        "node reboot": Fault(told=0.03, rests=0.4, code="drive-restarted", names="X: ", unknown=_SLIDES),
        "terminals reboot": Fault(told=0.03, rests=0.2, code="io-silent", names="io: ", unknown=_TERMINALS),
        "NMT stop": Fault(told=0.15, rests=0.45, code="drive-silent", names="Z: ", unknown=_SLIDES),
        "bus-off": replace(_DEAF, names="bus-off"),
        "two masters": replace(_DEAF, names="heartbeat"),
        "dead reader": replace(_DEAF, names="closed bus"),
    }
    harmless: ClassVar[tuple[str, ...]] = ("late answers",)
    missing: ClassVar[Mapping[str, str]] = {
        "outputs told": "a module of CiA 401 tells no output back; one that fails is a fault of the bus",
        "blocks": "its motion is planned here",
        "station": "its buttons hang on a module, whose silence is a fault of its own: silent terminals",
    }
    hold = 0.25
    runs_on = 0.14  # what is in the drives' queues
    rounds: ClassVar[int] = 2  # of the bus in a tick of the executor

    def __init__(self, *, homing: bool = False, turns: bool = False) -> None:
        """``turns``: the spindle's drive counts them."""
        counted = ("spindle = { id = 3 }", "spindle = { id = 3, counts_per_rev = 4096 }")
        estop = 'estop = { at = "401.6000.1.0"'
        probe = (estop, 'probe = { at = "401.6000.7.7" }\n' + estop)
        changes = (counted, ("encoder_ppr = 0 ", "encoder_ppr = 1024 ")) if turns else ()
        self.bench = CanBench(self.made(probe, *changes, absolute=not homing))
        self.peers, self.clock, self.machine = self.bench.peers, self.bench.clock, self.bench.model
        self.ports = self.bench.machine.ports
        self._answered, self._count = 1, 0  # the peers answer every so many rounds
        self.world = SimWorld(self.peers.machine, lambda: self.peers.plant.terminals.output_states)

    @staticmethod
    def made(*changes: tuple[str, str], absolute: bool) -> Machine:
        """The machine file."""
        return can_machine(*changes, absolute=absolute)

    def alone(self, dt: float) -> None:
        """Rounds of the bus, by the loop that owns it."""
        for _ in range(self.rounds):
            self.clock.advance(dt / self.rounds)
            self.round()
            self._count += 1
            if self._count % self._answered == 0:
                self.peers.process_frames()

    @property
    def slides(self) -> PlantControls:
        """Behind their drives."""
        return self.peers.machine

    def round(self) -> None:
        """One of the loop that owns the bus."""
        self.bench.machine.run_cycle()

    def acts(self) -> Mapping[str, Callable[[], None]]:
        """What nodes and bus can do."""
        nodes, machine = self.peers.nodes, self.peers.machine
        return {
            "drive fault": lambda: machine.drive_fault("X"),
            "following error": lambda: machine.jam("X"),
            "cable out": lambda: self.peers.cable(is_disconnected=True),
            "silence": lambda: setattr(nodes["Z"], "is_silent", True),
            "silent terminals": lambda: setattr(nodes["io"], "is_silent", True),
            "garbage": lambda: self._send(*[(0x181, b"\x27\x02")] * 3),
            "node reboot": nodes["X"].boot_up,
            "terminals reboot": nodes["io"].boot_up,
            "NMT stop": lambda: setattr(nodes["Z"], "state", 4),
            "bus-off": self._bus_off,
            "two masters": lambda: self._send((0x77F, b"\x05")),
            "dead reader": self._interface_fails,
            "late answers": self._answer_late,
        }

    def mend(self) -> None:
        """Cable in, slide free."""
        self.peers.cable(is_disconnected=False)
        self.peers.machine.jam("X", False)

    def close(self) -> None:
        """Both ends of the bus."""
        self.bench.close()

    def _send(self, *frames: tuple[int, bytes]) -> None:
        for cob, data in frames:
            self.peers.network.send_message(cob, data)

    def _bus_off(self) -> None:
        """The interface's own word: an error frame."""
        assert self.peers.network.bus is not None
        self.peers.network.bus.send(can.Message(arbitration_id=0x40, is_error_frame=True))

    def _answer_late(self) -> None:
        self._answered = 4

    def _interface_fails(self) -> None:
        assert self.bench.machine.bus.bus is not None
        self.bench.machine.bus.bus.shutdown()


class Csp(Canopen):
    """Told a position at each SYNC: cyclic synchronous position."""

    hold = 0.15
    runs_on = 0.03
    rounds = 5  # a SYNC every 4 ms, and a look between two of them

    @staticmethod
    def made(*changes: tuple[str, str], absolute: bool) -> Machine:
        """Drives of CiA 402 alone."""
        return cyclic("csp", *changes, absolute=absolute)


class Interpolated(Csp):
    """Told a position at each SYNC by 60C1h: interpolated position, as Schunk's and Pilz's drives have it."""

    @staticmethod
    def made(*changes: tuple[str, str], absolute: bool) -> Machine:
        """Drives of CiA 402 alone."""
        return cyclic("ip", *changes, absolute=absolute)


def bus_driven(machine: CanopenMachine) -> DriverBundle:
    """The bus as the driver host owns it; the bench closes it."""
    return DriverBundle(
        machine.ports,
        machine.run_cycle,
        close=lambda: None,
        get_next_tick_time=machine.get_next_cycle_time,
        collect_driver_messages=machine.collect_warnings,
    )


class FedCanopen(Canopen):
    """As it is shipped: the control here, bus and queue in the driver host."""

    faults: ClassVar[Mapping[str, Fault]] = {
        "cable out": Canopen.faults["cable out"],
        **HOST_FAULTS,
    }
    missing: ClassVar[Mapping[str, str]] = {
        **Canopen.missing,
        **dict.fromkeys(
            ("late answers", "node reboot", "bus-off", "two masters"),
            "the bus below the driver host is that of canopen: tried there",
        ),
    }
    harmless: ClassVar[tuple[str, ...]] = ()
    watched = True

    def __init__(self, *, homing: bool = False, turns: bool = False) -> None:
        super().__init__(homing=homing, turns=turns)
        self._mended = False
        self.host = DriverHost(bus_driven(self.bench.machine))
        self.link = BrokenLink(self.host)
        self.ports = create_host_ports(HostConnection(self.link, self.clock, self._again))

    def acts(self) -> Mapping[str, Callable[[], None]]:
        """What becomes of the driver host itself, and some of its bus."""
        own: dict[str, Callable[[], None]] = {
            fault: partial(self._gone, why) for fault, why in HOST_WORDS.items()
        }
        below = super().acts()
        return {fault: own.get(fault, below[fault]) for fault in self.faults}

    def _again(self) -> ConnectionAttempt[HostLink]:
        """Another process opens the bus and configures the drives as at a start."""

        def begun() -> HostLink:
            if not self._mended:
                raise DriverError("the driver host does not start", "feeder-gone")
            self.bench.machine.bus.close()
            self.bench.machine = connect_canopen_machine(self.machine, self.clock, self.peers.process_frames)
            self.host = DriverHost(bus_driven(self.bench.machine))
            self.link = BrokenLink(self.host)
            return clear_drive_faults(self.link)

        return ConnectionAttempt(begun, synchronous=True)

    def mend(self) -> None:
        """Another driver host can be started."""
        super().mend()
        self._mended = True

    def host_stands(self, seconds: float) -> None:
        """Its process is stopped for so long; drives and modules go on."""
        for _ in range(round(seconds / 0.002)):
            self.clock.advance(0.002)
            self.peers.process_frames()
        self.host.record_wakeup_delay(seconds)

    def round(self) -> None:
        """By the driver host; one that has ended does none."""
        if self.link.why != HOST_WORDS["dead reader"]:
            self.host.run_cycle()

    def _gone(self, why: str) -> None:
        self.link.why = why
        self.host.is_orphaned = True


class FedCsp(FedCanopen):
    """Through the driver host, a setpoint each SYNC to EPOS4 drives, by their own objects."""

    hold, runs_on, rounds = Csp.hold, Csp.runs_on, Csp.rounds

    @staticmethod
    def made(*changes: tuple[str, str], absolute: bool) -> Machine:
        """Slides and spindle of one family."""
        return cyclic("csp", *changes, drive="epos4", absolute=absolute)
