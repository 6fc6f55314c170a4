"""The settings of the line as rows that Return steps through; kept, at first those of the machine file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, fields, replace

from app.desk.pages.sheet import following
from app.desk.translation import tr
from core.machine.desk_tables import DncModel

BAUDS = (110, 300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200)
BITS = (("7E1", 7, "E", 1), ("7E2", 7, "E", 2), ("7O1", 7, "O", 1), ("8N1", 8, "N", 1), ("8N2", 8, "N", 2),
        ("8E1", 8, "E", 1), ("8O1", 8, "O", 1))  # fmt: skip
FLOWS = ("xonxoff", "rtscts", "none")
EOLS = ("\r\n", "\n", "\r")
LEADERS = (0, 50, 200, 1000)
_EOL_NAMES = {"\r\n": "CR LF", "\n": "LF", "\r": "CR"}
_FLOW_NAMES = {"xonxoff": "XON/XOFF", "rtscts": "RTS/CTS", "none": "NONE"}

Step = Callable[[DncModel, Sequence[str]], DncModel]
Row = tuple[str, Callable[[DncModel], str], Step]


def _bits(model: DncModel) -> str:
    return f"{model.bits}{model.parity}{model.stop}"


def _next_bits(model: DncModel, _ports: Sequence[str]) -> DncModel:
    name = following([each[0] for each in BITS], _bits(model))
    _, bits, parity, stop = next(each for each in BITS if each[0] == name)
    return replace(model, bits=bits, parity=parity, stop=stop)


def _yes(on: bool) -> str:
    return tr("YES") if on else tr("NO")


def _next_port(model: DncModel, ports: Sequence[str]) -> DncModel:
    return replace(model, port=following(ports, model.port)) if ports else model


ROWS: tuple[Row, ...] = (
    ("PORT", lambda m: m.port or "—", _next_port),
    ("SPEED", lambda m: f"{m.baud}", lambda m, _: replace(m, baud=following(BAUDS, m.baud))),
    ("BITS, PARITY, STOP BITS", _bits, _next_bits),
    (
        "FLOW CONTROL",
        lambda m: tr(_FLOW_NAMES[m.flow]),
        lambda m, _: replace(m, flow=following(FLOWS, m.flow)),
    ),
    (
        "START/END CHARACTER",
        lambda m: m.wrap or tr("NONE"),
        lambda m, _: replace(m, wrap="" if m.wrap else "%"),
    ),
    ("LINE ENDING", lambda m: _EOL_NAMES[m.eol], lambda m, _: replace(m, eol=following(EOLS, m.eol))),
    ("DC CODES", lambda m: _yes(m.dc_codes), lambda m, _: replace(m, dc_codes=not m.dc_codes)),
    ("SEND ONLY AFTER DC1", lambda m: _yes(m.wait), lambda m, _: replace(m, wait=not m.wait)),
    (
        "LEADING NULS",
        lambda m: f"{m.leader}",
        lambda m, _: replace(m, leader=following(LEADERS, m.leader)),
    ),
)


def stored_form(model: DncModel) -> dict[str, object]:
    """The settings as the store keeps them."""
    return asdict(model)


def settings_of(kept: object, default: DncModel) -> DncModel:
    """What was kept, as far as it is still good; else the machine file's."""
    if not isinstance(kept, dict):
        return default
    good = {
        field.name: kept[field.name]
        for field in fields(DncModel)
        if type(kept.get(field.name)) is type(getattr(default, field.name))
    }
    model = replace(default, **good)
    known = model.flow in FLOWS and model.eol in EOLS and model.wrap in {"%", ""} and model.bits in {7, 8}
    return model if known and model.parity in {"N", "E", "O"} and model.stop in {1, 2} else default
