"""An I/O module as somebody else reads the standards: SDO, NMT, PDOs and heartbeat of the durand library."""

from __future__ import annotations

from collections.abc import Callable

import can
from durand import Array, MinimalNode, Variable, set_scheduler
from durand.datatypes import DatatypeEnum as Kind
from durand.scheduler import AsyncScheduler, VirtualScheduler

NODE = 10


class Wire:
    """Its end of the bus, read when the test says so."""

    def __init__(self, channel: str) -> None:
        self.bus = can.Bus(interface="virtual", channel=channel)
        self._heard: dict[int, Callable[[int, bytes], None]] = {}

    def add_subscription(self, cob_id: int, callback: Callable[[int, bytes], None]) -> None:
        self._heard[cob_id] = callback

    def remove_subscription(self, cob_id: int) -> None:
        self._heard.pop(cob_id)

    def send(self, cob_id: int, msg: bytes) -> None:
        self.bus.send(can.Message(arbitration_id=cob_id, data=msg, is_extended_id=False))

    def pump(self) -> None:
        """Everything that has come."""
        while (message := self.bus.recv(0.0)) is not None:
            if message.arbitration_id in self._heard:
                self._heard[message.arbitration_id](message.arbitration_id, bytes(message.data))


class ForeignModule:
    """So many bytes of inputs and outputs, and analog words; an object that it has none of is not there."""

    def __init__(self, channel: str, inputs: int, outputs: int, words: int) -> None:
        self._time = VirtualScheduler()
        set_scheduler(self._time)
        self.wire = Wire(channel)
        self.node = MinimalNode(self.wire, NODE)
        objects = self.objects = self.node.object_dictionary
        objects[0x1000] = Variable(Kind.UNSIGNED32, "const", 0x000F0191)
        objects[0x1016] = Array(Variable(Kind.UNSIGNED32, "rw"), 1)
        if inputs:
            objects[0x6000] = Array(Variable(Kind.UNSIGNED8, "ro"), inputs)
        for index in (0x6200, 0x6206, 0x6207) if outputs else ():
            objects[index] = Array(Variable(Kind.UNSIGNED8, "rw"), outputs)
        if words:
            objects[0x6401] = Array(Variable(Kind.INTEGER16, "ro"), words)
            objects[0x6423] = Variable(Kind.UNSIGNED8, "rw")
            objects[0x6426] = Array(Variable(Kind.UNSIGNED32, "rw"), words)

    def fix_mapping(self) -> None:
        """Its PDOs carry what there is, and nobody can change that."""
        self.node.tpdo[0].mapping = [(0x6000, 1)]
        self.node.rpdo[0].mapping = [(0x6200, 1)]
        for index in (0x1600, 0x1A00):
            for sub in range(9):
                self.objects.validate_callbacks[index, sub].add(_refused)

    def pump(self, seconds: float = 0.0) -> None:
        """What has come is heard, and time goes on."""
        self.wire.pump()
        if seconds:
            self._time.run(seconds)

    def close(self) -> None:
        self.wire.bus.shutdown()
        set_scheduler(AsyncScheduler())


def _refused(_value: int) -> None:
    raise ValueError("this mapping is fixed")
