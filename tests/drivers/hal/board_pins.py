"""Pins of boards that are not here, by the sources of their drivers, and a HAL file without its board.

Names, kinds and directions as LinuxCNC 2.9 exports them: ``mesa-hostmot2`` (stepgen.c, encoder.c, pwmgen.c,
inmux.c, ssr.c, watchdog.c, and a listing of a 7I76E's field I/O), hal-cia402 (cia402.comp) and the generic
slaves of linuxcnc-ethercat.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

IN, OUT, BOTH, PARAM = "IN", "OUT", "IO", "RW"
_GONE = re.compile(
    r"loadrt (hostmot2|hm2_eth|lcec|cia402)\b.*|loadusr -W lcec_conf .*|addf (hm2_|lcec\.|cia402\.)\S* .*"
)
_STEPGEN = (
    ("position-cmd", "float", IN), ("velocity-cmd", "float", IN), ("position-fb", "float", OUT),
    ("velocity-fb", "float", OUT), ("counts", "s32", OUT), ("enable", "bit", IN), ("control-type", "bit", IN),
    ("position-reset", "bit", IN), ("position-scale", "float", PARAM), ("maxvel", "float", PARAM),
    ("maxaccel", "float", PARAM), ("steplen", "u32", PARAM), ("stepspace", "u32", PARAM),
    ("dirsetup", "u32", PARAM), ("dirhold", "u32", PARAM), ("step_type", "u32", PARAM),
)  # fmt: skip
_ENCODER = (
    ("rawcounts", "s32", OUT), ("count", "s32", OUT), ("position", "float", OUT), ("velocity", "float", OUT),
    ("velocity-rpm", "float", OUT), ("reset", "bit", IN), ("index-enable", "bit", BOTH),
    ("scale", "float", PARAM), ("index-invert", "bit", PARAM), ("index-mask", "bit", PARAM),
    ("index-mask-invert", "bit", PARAM), ("counter-mode", "bit", PARAM), ("filter", "bit", PARAM),
)  # fmt: skip
_PWMGEN = (
    ("value", "float", IN), ("enable", "bit", IN), ("offset-mode", "bit", PARAM), ("scale", "float", PARAM),
    ("output-type", "s32", PARAM),
)  # fmt: skip
_CIA402 = (
    ("statusword", "u32", IN), ("opmode-display", "s32", IN), ("drv-actual-position", "s32", IN),
    ("drv-actual-velocity", "s32", IN), ("controlword", "u32", OUT), ("opmode", "s32", OUT),
    ("drv-target-position", "s32", OUT), ("drv-target-velocity", "s32", OUT), ("enable", "bit", IN),
    ("pos-cmd", "float", IN), ("velocity-cmd", "float", IN), ("pos-fb", "float", OUT),
    ("velocity-fb", "float", OUT), ("drv-fault", "bit", OUT), ("home", "bit", BOTH),
    ("stat-op-enabled", "bit", OUT), ("fault-reset", "bit", IN), ("pos-scale", "float", PARAM),
    ("velo-scale", "float", PARAM), ("auto-fault-reset", "bit", PARAM), ("csp-mode", "bit", PARAM),
)  # fmt: skip
_SLAVE = (
    ("cia-controlword", "u32", IN), ("opmode", "s32", IN), ("target-position", "s32", IN),
    ("target-velocity", "s32", IN), ("cia-statusword", "u32", OUT), ("opmode-display", "s32", OUT),
    ("actual-position", "s32", OUT), ("actual-velocity", "s32", OUT),
)  # fmt: skip


class BoardPin(NamedTuple):
    """One pin or parameter of a board."""

    name: str
    kind: str
    way: str


def _of(prefix: str, pins: tuple[tuple[str, str, str], ...]) -> Iterator[BoardPin]:
    yield from (BoardPin(f"{prefix}.{name}", kind, way) for name, kind, way in pins)


def _watchdog(card: str) -> Iterator[BoardPin]:
    yield BoardPin(f"{card}.watchdog.has_bit", "bit", BOTH)
    yield BoardPin(f"{card}.packet-error-exceeded", "bit", OUT)
    yield BoardPin(f"{card}.io_error", "bit", PARAM)
    yield BoardPin(f"{card}.watchdog.timeout_ns", "u32", PARAM)


def mesa_7i76e() -> Iterator[BoardPin]:
    """Step generators, encoder, and the field I/O with its spindle."""
    card = "hm2_7i76e.0"
    yield from _watchdog(card)
    for number in range(5):
        yield from _of(f"{card}.stepgen.{number:02d}", _STEPGEN)
    yield BoardPin(f"{card}.dpll.01.timer-us", "float", IN)
    yield BoardPin(f"{card}.stepgen.timer-number", "s32", IN)
    yield BoardPin(f"{card}.sserial.port-0.fault-count", "u32", OUT)
    yield from _of(f"{card}.encoder.00", _ENCODER)
    field = f"{card}.7i76.0.0"
    for number in range(32):
        yield BoardPin(f"{field}.input-{number:02d}", "bit", OUT)
        yield BoardPin(f"{field}.input-{number:02d}-not", "bit", OUT)
    yield from (BoardPin(f"{field}.output-{number:02d}", "bit", IN) for number in range(16))
    yield BoardPin(f"{field}.spinout", "float", IN)
    yield from (BoardPin(f"{field}.{name}", "bit", IN) for name in ("spinena", "spindir"))
    yield from (
        BoardPin(f"{field}.spinout-{name}", "float", PARAM) for name in ("scalemax", "maxlim", "minlim")
    )


def mesa_7i97() -> Iterator[BoardPin]:
    """Analog outputs, encoders, inputs and relays."""
    card = "hm2_7i97.0"
    yield from _watchdog(card)
    yield BoardPin(f"{card}.pwmgen.pwm_frequency", "u32", PARAM)
    for number in range(6):
        yield from _of(f"{card}.pwmgen.{number:02d}", _PWMGEN)
        yield from _of(f"{card}.encoder.{number:02d}", _ENCODER)
        yield BoardPin(f"{card}.ssr.00.out-{number:02d}", "bit", IN)
    for number in range(16):
        yield BoardPin(f"{card}.inmux.00.input-{number:02d}", "bit", OUT)
        yield BoardPin(f"{card}.inmux.00.input-{number:02d}-not", "bit", OUT)


def ethercat() -> Iterator[BoardPin]:
    """Two slides and a spindle with their slaves, an EL1008, an EL2008."""
    for name in ("x", "z", "spindle"):
        yield from _of(f"cia402.{name}", _CIA402)
        yield from _of(f"lcec.0.{name}", _SLAVE)
    for name in ("link-up", "all-op"):
        yield BoardPin(f"lcec.0.{name}", "bit", OUT)
    for name in ("x", "z", "spindle", "DI", "DO"):
        yield BoardPin(f"lcec.0.{name}.slave-oper", "bit", OUT)
    for number in range(8):
        yield BoardPin(f"lcec.0.DI.din-{number}", "bit", OUT)
        yield BoardPin(f"lcec.0.DI.din-{number}-not", "bit", OUT)
        yield BoardPin(f"lcec.0.DO.dout-{number}", "bit", IN)


PINS = {"mesa-7i76e": mesa_7i76e, "mesa-7i97": mesa_7i97, "ethercat": ethercat}


def without_board(text: str, stand_in: str) -> str:
    """The HAL file with its board left out: ``stand_in`` is loaded where the first component is."""
    lines = [line for line in text.splitlines() if not _GONE.fullmatch(line)]
    lines = [re.sub(r"loadrt hal_parport .*", "loadrt sim_parport names=parport.0", line) for line in lines]
    place = next(n for n, line in enumerate(lines) if line.startswith("loadrt "))
    return "\n".join((*lines[: place + 1], stand_in, *lines[place + 1 :], ""))
