"""Every key of the tables about wires, with its range."""

from __future__ import annotations

from core.machine.schema import Field, Kind
from core.machine.units import Unit

BAUDS = 110, 1_000_000
PARITIES = ("N", "E", "O")
VFD_FAMILIES = ("delta-vfdb", "hitachi-wj200", "huanyang")
SPINDLE_DRIVERS = ("sim", "cia402", "vfd", "grblhal")
SIM_FAULTS = (
    "jam",
    "encoder_stuck",
    "runaway",
    "drive_fault",
    "spindle_bog",
    "spindle_wander",
    "spindle_ignores_stop",
    "spindle_fault",
    "collet_sensor_stuck",
    "station_silent",
    "pot_noise",
    "estop",
)
AXIS_FAULTS = frozenset(("jam", "encoder_stuck", "runaway", "drive_fault"))

_NUMBER, _WHOLE, _FLAG, _TEXT, _CHOICE = Kind.NUMBER, Kind.WHOLE, Kind.FLAG, Kind.TEXT, Kind.CHOICE

CANOPEN = (
    Field("interface", _TEXT, default="socketcan"),
    Field("channel", _TEXT),
    Field("bitrate", _WHOLE, low=10_000, high=1_000_000, default=1_000_000),
    Field("sync_ms", _NUMBER, Unit.MILLISECONDS, 0.001, 0.1, default=0.01),
    Field("host_id", _WHOLE, low=1, high=127, default=127),
    Field("heartbeat_ms", _NUMBER, Unit.MILLISECONDS, 0.02, 2.0, default=0.1),
    Field("mode", _CHOICE, choices=("pvt", "pp", "csp")),
    Field("experimental", _FLAG, default=False),
    Field("record_ms", _NUMBER, Unit.MILLISECONDS, 0.002, 0.05, default=0.02),
)
NODE = (
    Field("id", _WHOLE, low=1, high=127),
    Field("profile", _WHOLE, low=401, high=406, default=402),
    Field("eds", _TEXT, default=""),
    Field("counts_per_rev", _WHOLE, low=0, high=100_000_000, default=0),
)
VFD = (
    Field("family", _CHOICE, choices=VFD_FAMILIES),
    Field("port", _TEXT),
    Field("baud", _WHOLE, low=BAUDS[0], high=BAUDS[1], default=9600),
    Field("parity", _CHOICE, choices=PARITIES, default="N"),
    Field("stop", _WHOLE, low=1, high=2, default=1),
    Field("id", _WHOLE, low=1, high=247, default=1),
    Field("comm_loss_s", _NUMBER, Unit.SECONDS, 0.2, 10.0, default=1.5),
    Field("hz_per_rpm", _NUMBER, Unit.PLAIN, 0.001, 1.0),
    Field("disagree_pct", _NUMBER, Unit.PERCENT, 0.05, 0.5, default=0.15),
)
ENCODER = (
    Field("node", _TEXT),
    Field("object", _TEXT, default=""),
    Field("counts_per_rev", _WHOLE, low=-100_000_000, high=100_000_000),
)
GRBLHAL = (
    Field("port", _TEXT),
    Field("baud", _WHOLE, low=BAUDS[0], high=4_000_000, default=115_200),
    Field("x_mode", _CHOICE, choices=("G7", "G8"), default="G8"),
)
DNC = (
    Field("port", _TEXT),
    Field("baud", _WHOLE, low=BAUDS[0], high=BAUDS[1], default=9600),
    Field("bits", _WHOLE, low=7, high=8, default=8),
    Field("parity", _CHOICE, choices=PARITIES, default="N"),
    Field("stop", _WHOLE, low=1, high=2, default=1),
    Field("flow", _CHOICE, choices=("xonxoff", "rtscts", "none"), default="xonxoff"),
    Field("wrap", _CHOICE, choices=("%", ""), default="%"),
    Field("eol", _CHOICE, choices=("\r\n", "\n", "\r"), default="\r\n"),
    Field("dc_codes", _FLAG, default=False),
    Field("wait", _FLAG, default=False),
    Field("leader", _WHOLE, low=0, high=2000, default=0),
)
MTCONNECT = (
    Field("enabled", _FLAG, default=False),
    Field("bind", _TEXT, default="127.0.0.1"),
    Field("port", _WHOLE, low=1, high=65535, default=7878),
    Field("heartbeat_ms", _NUMBER, Unit.MILLISECONDS, 0.001, 1800.0, default=10.0),
    Field("device", _TEXT, default="TurnDesk"),
)
ANALOG = (
    Field("at", _TEXT),
    Field("range", Kind.PAIR, Unit.PLAIN, -1000.0, 1000.0, default=(0.0, 1.0)),
    Field("switch", _TEXT, default=""),
    Field("counts_per_click", _WHOLE, low=-1000, high=1000, default=1),
)
FAULT = (
    Field("at", _NUMBER, Unit.SECONDS, 0.0, 1e6),
    Field("what", _CHOICE, choices=SIM_FAULTS),
    Field("axis", _TEXT, default=""),
    Field("value", _NUMBER, Unit.PLAIN, -1e6, 1e6, default=0.0),
    Field("seconds", _NUMBER, Unit.SECONDS, 0.0, 1e6, default=0.0),
    Field("text", _TEXT, default=""),
)
ANALOG_NAMES = ("feed_pot", "spindle_pot", "handwheel")

# Tables that a file may have or not, and their keys.
TABLES = (
    ("canopen", CANOPEN, ("nodes", "sdo")),
    ("grblhal", GRBLHAL, ("settings",)),
    ("dnc", DNC, ()),
    ("mtconnect", MTCONNECT, ()),
)
TOP = tuple(path for path, _, _ in TABLES)
