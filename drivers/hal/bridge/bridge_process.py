"""Process of the bridge, started by halrun as ``/usr/bin/python3 bridge_process.py FILE``.

FILE is the configuration. The process checks that HAL has every pin of the machine file, connects its own
pins, and plays setpoints until the driver ends.
"""

from __future__ import annotations

import fcntl
import importlib
import json
import os
import select
import signal
import socket
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[3]))

from drivers.hal.bridge import hal_pins
from drivers.hal.bridge.hal_bridge import Bridge
from drivers.hal.bridge.packets import BridgeAxis, BridgeConfig, Head, pack, unpack

_PERIOD = 0.002  # Seconds between two cycles.
_REPORTS = 2  # Cycles between two reports.
_PRIORITY = 45  # Below the priority of the driver host.
_LARGEST = 1 << 17
_KINDS = {"float": "HAL_FLOAT", "bit": "HAL_BIT", "s32": "HAL_S32"}
_WAYS = {"in": "HAL_IN", "out": "HAL_OUT", "io": "HAL_IO"}


def main(arguments: list[str]) -> int:
    """Run the bridge until the driver ends or a pin does not match the machine file; return the exit code.

    SIGINT is ignored, because the control brakes the axes and then ends this process.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    said = json.loads(Path(arguments[0]).read_text(encoding="utf-8"))
    sock = socket.socket(fileno=said["fd"])
    try:
        hal = importlib.import_module("hal")  # Only the system's Python has this module.
    except ImportError as error:
        sock.send(
            pack(
                {
                    "error": (
                        f"{sys.executable} does not have the hal module ({error}); check that it is "
                        "LinuxCNC's Python"
                    )
                }
            )
        )
        return 1
    try:
        component = _component(hal, said)
    except (RuntimeError, OSError, hal.error) as error:
        sock.send(pack({"error": str(error)}))
        return 1
    if component is None:
        return 1
    bridge = _bridge(hal, component, said)
    sock.send(pack({"ready": True, "pid": os.getpid(), "warnings": _real_time()}))
    with Path(said["alive"]).open("wb") as alive:
        fcntl.flock(alive, fcntl.LOCK_EX)
        component.ready()
        _serve(sock, bridge, lambda: time.monotonic() - said["zero"])
        Path(said["ended"]).touch()  # HAL need not continue, as it does after a crash of the bridge.
    return 0


def _component(hal: Any, said: Mapping[str, Any]) -> Any | None:
    """Create the HAL component and connect its pins.

    Return None if pins do not match or only a check was requested.
    """
    sock = socket.socket(fileno=os.dup(said["fd"]))
    wanted = [hal_pins.Wanted(*each) for each in said["wanted"]]
    pins = hal_pins.pins_of(hal_pins.halcmd("-s", "show", "pin"))
    signals = hal_pins.signals_of(pins, hal_pins.halcmd("-s", "show", "sig"))
    verdicts = [(each.path, each.pin, hal_pins.trouble(each, pins, signals)) for each in wanted]
    sock.send(pack({"verdicts": verdicts}))
    if said["only_check"] or any(wrong for _, _, wrong in verdicts):
        return None
    component = hal.component(said["name"])
    for name, kind, way in said["pins"]:
        component.newpin(name, getattr(hal, _KINDS[kind]), getattr(hal, _WAYS[way]))
    script = Path(said["nets"])
    script.write_text("\n".join(hal_pins.nets(wanted, said["own"], pins, signals)) + "\n", encoding="utf-8")
    hal_pins.halcmd("-f", str(script))
    for each in wanted:  # The start of a session, like an E-stop, does not change these outputs.
        output = each.path.removeprefix("io.out.")
        if output in said["bridge"]["outputs"] and said["bridge"]["outputs"][output] is None:
            component[f"out.{output}"] = hal_pins.is_on(each.pin, pins, signals)
    return component


def _bridge(hal: Any, component: Any, said: Mapping[str, Any]) -> Bridge:
    told = dict(said["bridge"])
    told["axes"] = tuple(BridgeAxis(**axis) for axis in told["axes"])
    config = BridgeConfig(**told)
    streams = [hal.stream(component, hal.streamer_base + n, said["columns"]) for n in range(2)]
    sampler = hal.stream(component, hal.sampler_base, said["sampled"])
    return Bridge(
        config, component, (streams[0], streams[1]), sampler, lambda: time.monotonic() - said["zero"]
    )


def _real_time() -> list[str]:
    """Request SCHED_FIFO and return a message for the operator if it was refused."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_PRIORITY))
    except OSError as error:
        return [
            f"the HAL bridge runs without real-time priority ({error.strerror}); "
            "see docs/integrator/computer.md"
        ]
    return []


def _serve(sock: socket.socket, bridge: Bridge, now: Callable[[], float]) -> None:
    sock.setblocking(False)
    due, count = now(), 0
    while not bridge.done:
        late = now() - due
        bridge.round(max(late, 0.0))
        if late >= 0.0:
            due = max(due + _PERIOD, now())
            count += 1
            if count % _REPORTS == 0 and not bridge.gone:
                _tell(sock, bridge)
        left = max(due - now(), 0.0)
        if bridge.gone:
            time.sleep(left)
        elif select.select([sock], [], [], left)[0]:  # Received packets are executed at once.
            for head, numbers in _heard(sock, bridge):
                bridge.handle(head, numbers)


def _tell(sock: socket.socket, bridge: Bridge) -> None:
    """Send a report; if the driver does not read, skip it until the next report."""
    try:
        sock.send(bridge.report())
    except BlockingIOError:
        return
    except OSError:
        bridge.gone = True


def _heard(sock: socket.socket, bridge: Bridge) -> Iterator[tuple[Head, Any]]:
    while not bridge.gone:
        try:
            data = sock.recv(_LARGEST)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            bridge.gone = True
            return
        yield unpack(data)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
