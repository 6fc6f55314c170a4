"""Every driver of this product. A new one adds its maker here, and its faults to its class."""

from __future__ import annotations

from tests.drivers.contract.can import Canopen, Csp, FedCanopen, FedCsp, Interpolated
from tests.drivers.contract.grbl import Grblhal
from tests.drivers.contract.hal import Hal
from tests.drivers.contract.inverters import DeltaVfdB, HitachiWj200, HuanyangHy, OwnFile
from tests.drivers.contract.rig import Rig
from tests.drivers.contract.simulated import Fed, Simulated
from tests.drivers.contract.skeleton import Skeleton

RIGS: dict[str, type[Simulated | Fed | Canopen | FedCanopen | Grblhal | Hal | Skeleton]] = {
    "simulated": Simulated,
    "fed": Fed,
    "canopen": Canopen,
    "fed canopen": FedCanopen,
    "csp": Csp,
    "fed csp": FedCsp,
    "interpolated": Interpolated,
    "grblhal": Grblhal,
    "hal": Hal,
    "delta": DeltaVfdB,
    "hitachi": HitachiWj200,
    "huanyang": HuanyangHy,
    "own inverter": OwnFile,
    "skeleton": Skeleton,
}


def make(name: str, *, homing: bool = False) -> Rig:
    """A fresh bench, drives off; ``homing``: Z has to be homed."""
    return RIGS[name](homing=homing)
