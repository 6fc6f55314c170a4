"""What the machine is wired to, as its file describes it: buses, drives, serial lines, pots, simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class SdoValue:
    """One object that is written at every start and read back."""

    index: int
    sub: int
    value: int

    @property
    def address(self) -> str:
        """As the machine file writes it."""
        return f"{self.index:04X}:{self.sub}"


@dataclass(frozen=True, slots=True)
class CanNode:
    """One node of the bus: ``name`` is an axis, ``spindle`` or the name of an I/O module."""

    name: str
    id: int
    profile: int  # 402, 401 or 406
    eds: str = ""  # file of the object dictionary; empty: the standard objects
    counts_per_rev: int = 0  # the drive counts velocities in rpm of this many counts; 0: in counts/s
    sdo: tuple[SdoValue, ...] = ()  # those for all nodes of its profile, then its own


@dataclass(frozen=True, slots=True)
class CanopenModel:
    """The CAN bus and what hangs on it. Times in seconds."""

    interface: str  # python-can's name: socketcan, virtual, udp_multicast …
    channel: str
    bitrate: int
    sync: float
    host_id: int
    heartbeat: float
    mode: str  # pvt, pp or csp
    experimental: bool  # csp is allowed
    record: float  # length of a PVT record
    nodes: tuple[CanNode, ...]


@dataclass(frozen=True, slots=True)
class VfdModel:
    """A frequency inverter on a serial line."""

    family: str
    port: str
    baud: int
    parity: str  # N, E or O
    stop: int  # stop bits
    id: int
    comm_loss: float  # s, the inverter's own time-out
    hz_per_rpm: float
    disagree: float = 0.15  # fraction by which an encoder may differ from what the inverter gives


@dataclass(frozen=True, slots=True)
class EncoderModel:
    """An encoder on the spindle, on the bus: a node of its own, or a drive's second input."""

    node: str  # name in [canopen.nodes]
    index: int
    sub: int
    counts_per_rev: int  # negative: it counts down with M03


@dataclass(frozen=True, slots=True)
class GrblhalModel:
    """A motion controller with its own planner. ``settings`` are written at each connection and read back."""

    port: str  # a serial device, or tcp://host:port
    baud: int
    x_mode: str  # G8 radius or G7 diameter
    settings: Mapping[int, float | str]


@dataclass(frozen=True, slots=True)
class DncModel:
    """The serial line for programs."""

    port: str
    baud: int
    bits: int
    parity: str  # N, E or O
    stop: int
    flow: str  # xonxoff, rtscts or none
    wrap: str  # the line before and behind a program; empty: none
    eol: str
    dc_codes: bool = False  # DC2 and DC4 around what is sent, DC1 and DC3 around what is received
    wait: bool = False  # send only when the other side has said DC1
    leader: int = 0  # NULs before and behind what is sent


@dataclass(frozen=True, slots=True)
class MtconnectModel:
    """The adapter for shop-floor data; ``heartbeat`` in seconds."""

    enabled: bool
    bind: str
    port: int
    heartbeat: float
    device: str


@dataclass(frozen=True, slots=True)
class AnalogModel:
    """A pot or a counting wheel: ``low`` … ``high`` is what both ends mean; ``switch`` names its input.

    ``counts_per_click`` of the handwheel; negative: it turns the other way round.
    """

    name: str
    terminal: str
    low: float
    high: float
    switch: str = ""
    counts_per_click: int = 1


@dataclass(frozen=True, slots=True)
class SimFault:
    """Something that the simulation breaks ``at`` so many seconds; ``seconds`` 0: for good."""

    at: float
    what: str
    axis: str = ""
    value: float = 0.0
    seconds: float = 0.0
    text: str = ""


@dataclass(frozen=True, slots=True)
class SimModel:
    """The simulated machine's own settings."""

    seed: int = 1
    realtime: bool = False  # a run without a screen keeps the machine's pace too
    faults: tuple[SimFault, ...] = ()


@dataclass(frozen=True, slots=True)
class HomeModel:
    """How a real drive looks for home: CiA 402 method, the slow speed, and where home lies from the mark."""

    method: int = 0  # 0: not said
    latch: float = 0.0  # mm/s
    offset: float = 0.0  # mm


@dataclass(frozen=True, slots=True)
class Hardware:
    """Everything about wires; None where the file has no such table."""

    feeder: bool = False  # the drivers run in a process of their own
    spindle_driver: str = "sim"  # sim, cia402, vfd or grblhal
    canopen: CanopenModel | None = None
    vfd: VfdModel | None = None
    encoder: EncoderModel | None = None  # beside an inverter
    grblhal: GrblhalModel | None = None
    dnc: DncModel | None = None
    mtconnect: MtconnectModel | None = None
    sim: SimModel = field(default_factory=SimModel)
    analog: Mapping[str, AnalogModel] = field(default_factory=dict)
    homes: Mapping[str, HomeModel] = field(default_factory=dict)  # by axis
    refresh: Mapping[str, float] = field(
        default_factory=dict
    )  # output → s after which it falls if not renewed
