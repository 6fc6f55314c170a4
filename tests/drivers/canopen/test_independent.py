"""The peer under a master that is not ours: the canopen library's own CiA 402 profile."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import canopen
import pytest
from canopen.profiles.p402 import BaseNode402

from app.compose.backends.canopen_backend import create_simulated_devices
from drivers.canopen.canopen_objects import build_drive_dictionary
from drivers.canopen.canopen_table import CanopenTable
from drivers.simulators.canopen_devices import CanopenDevices
from drivers.wakeups import RealClock
from tests.drivers.canopen.bench import can_machine

PATIENT = (
    "TIMEOUT_SWITCH_STATE_FINAL",
    "TIMEOUT_SWITCH_STATE_SINGLE",
    "TIMEOUT_SWITCH_OP_MODE",
    "TIMEOUT_CHECK_TPDO",
)


class Patient(BaseNode402):
    """For a loaded computer."""

    def __init__(self, number: int, objects: canopen.ObjectDictionary) -> None:
        BaseNode402.__init__(self, number, objects)


for name in PATIENT:
    setattr(Patient, name, 20.0)


@pytest.fixture
def shop() -> Iterator[tuple[CanopenDevices, BaseNode402]]:
    """X of the shipped machine under the library's master, each end with threads of its own."""
    machine = can_machine()
    bus = machine.hardware.find_driver_table(CanopenTable)
    assert bus is not None
    peers, ended = create_simulated_devices(machine, RealClock()), threading.Event()

    def play() -> None:
        while not ended.is_set():
            peers.process_frames(0.001)

    thread = threading.Thread(target=play)
    thread.start()
    network = canopen.Network()
    network.connect(interface="virtual", channel=bus.channel)
    node = Patient(1, build_drive_dictionary())
    network.add_node(node)
    node.sdo.RESPONSE_TIMEOUT = 20.0
    yield peers, node
    network.sync.stop()
    network.disconnect()
    ended.set()
    thread.join(60.0)
    peers.close()


def test_canopen_library_profile_enables_the_simulated_drive(
    shop: tuple[CanopenDevices, BaseNode402],
) -> None:
    peers, node = shop
    node.nmt.state = "PRE-OPERATIONAL"
    node.rpdo[1].clear()
    for index in (0x6040, 0x6060):
        node.rpdo[1].add_variable(index)
    node.tpdo[1].clear()
    for index in (0x6041, 0x6061):
        node.tpdo[1].add_variable(index)
    for pdo, kind in ((node.rpdo[1], 255), (node.tpdo[1], 1)):
        pdo.cob_id, pdo.trans_type, pdo.enabled = pdo.predefined_cob_id, kind, True
        pdo.com_record[1].raw = pdo.cob_id
        pdo.com_record[2].raw = kind
        for sub, variable in enumerate(pdo.map, 1):
            pdo.map_array[sub].raw = variable.index << 16 | variable.length
        pdo.map_array[0].raw = len(pdo.map)
    node.tpdo[1].subscribe()
    node.nmt.state = "OPERATIONAL"
    node.network.sync.start(0.01)
    node.setup_402_state_machine(read_pdos=False)
    node.state = "OPERATION ENABLED"
    assert node.state == "OPERATION ENABLED"
    assert peers.plant.axis_drives["X"].power_states.is_powered
    node.op_mode = "PROFILED POSITION"
    assert node.op_mode == "PROFILED POSITION"
    node.state = "SWITCH ON DISABLED"
    assert not peers.plant.axis_drives["X"].power_states.is_powered
