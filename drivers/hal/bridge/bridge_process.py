"""Process of the HAL bridge, started by halrun as ``/usr/bin/python3 bridge_process.py FILE``.

FILE is the configuration. The process checks that HAL has every pin of the machine file, and connects its
own pins. It then plays setpoints until the driver ends.
"""

from __future__ import annotations

import fcntl
import importlib
import json
import os
import signal
import socket
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[3]))

from drivers.hal.bridge import hal_pins
from drivers.hal.bridge.hal_bridge import HalBridge
from drivers.hal.bridge.packets import BridgeAxis, BridgeConfig, pack_packet
from drivers.process_messages import MessageSocket
from drivers.process_rights import request_scheduling_policy

_PERIOD = 0.002  # Seconds between two cycles.
_CYCLES_PER_REPORT = 2  # Cycles between two reports.
_PRIORITY = 45  # Below the priority of the driver host.
_PIN_KINDS = {"float": "HAL_FLOAT", "bit": "HAL_BIT", "s32": "HAL_S32"}
_PIN_DIRECTIONS = {"in": "HAL_IN", "out": "HAL_OUT", "io": "HAL_IO"}


def main(arguments: list[str]) -> int:
    """Run the bridge until the driver ends or a pin does not match the machine file.

    Returns the exit code. SIGINT is ignored, because the control brakes the axes and then ends this
    process.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    said = json.loads(Path(arguments[0]).read_text(encoding="utf-8"))
    sock = MessageSocket(socket.socket(fileno=said["fd"]))
    try:
        hal = importlib.import_module("hal")  # Only the system's Python has this module.
    except ImportError as error:
        sock.send(
            pack_packet(
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
        component = _create_component(hal, sock, said)
    except (RuntimeError, OSError, hal.error) as error:
        sock.send(pack_packet({"error": str(error)}))
        return 1
    if component is None:
        return 1
    bridge = _bridge(hal, component, said)
    cause = request_scheduling_policy("SCHED_FIFO", _PRIORITY)
    words = f"the HAL bridge runs without real-time priority ({cause}); see docs/integrator/computer.md"
    warnings = [words] if cause else []
    sock.send(pack_packet({"ready": True, "pid": os.getpid(), "warnings": warnings}))
    with Path(said["alive"]).open("wb") as alive:
        fcntl.flock(alive, fcntl.LOCK_EX)
        component.ready()
        _serve(sock, bridge, lambda: time.monotonic() - said["zero"])
        Path(said["ended"]).touch()  # HAL need not continue, as it does after a crash of the bridge.
    return 0


def _create_component(hal: Any, sock: MessageSocket, settings: Mapping[str, Any]) -> Any | None:
    """Create the HAL component and connect its pins.

    Returns None if a pin does not match the machine file, or if only a check was requested.
    """
    wanted = [hal_pins.ExpectedPin(*each) for each in settings["wanted"]]
    pins = hal_pins.parse_pins(hal_pins.run_halcmd("-s", "show", "pin"))
    signals = hal_pins.parse_signals(pins, hal_pins.run_halcmd("-s", "show", "sig"))
    verdicts = [
        (each.machine_file_key, each.pin_name, hal_pins.describe_pin_error(each, pins, signals))
        for each in wanted
    ]
    sock.send(pack_packet({"verdicts": verdicts}))
    if settings["only_check"] or any(wrong for _, _, wrong in verdicts):
        return None
    component = hal.component(settings["name"])
    for name, kind, direction in settings["pins"]:
        component.newpin(name, getattr(hal, _PIN_KINDS[kind]), getattr(hal, _PIN_DIRECTIONS[direction]))
    script = Path(settings["nets"])
    script.write_text(
        "\n".join(hal_pins.build_net_lines(wanted, settings["own"], pins, signals)) + "\n", encoding="utf-8"
    )
    hal_pins.run_halcmd("-f", str(script))
    for each in wanted:  # The start of a session, like an E-stop, does not change these outputs.
        output = each.machine_file_key.removeprefix("io.out.")
        if output in settings["bridge"]["outputs"] and settings["bridge"]["outputs"][output] is None:
            component[f"out.{output}"] = hal_pins.is_pin_on(each.pin_name, pins, signals)
    return component


def _bridge(hal: Any, component: Any, said: Mapping[str, Any]) -> HalBridge:
    bridge_settings = dict(said["bridge"])
    bridge_settings["axes"] = tuple(BridgeAxis(**axis) for axis in bridge_settings["axes"])
    config = BridgeConfig(**bridge_settings)
    streams = [hal.stream(component, hal.streamer_base + n, said["columns"]) for n in range(2)]
    sampler = hal.stream(component, hal.sampler_base, said["sampled"])
    return HalBridge(
        config, component, (streams[0], streams[1]), sampler, lambda: time.monotonic() - said["zero"]
    )


def _serve(sock: MessageSocket, bridge: HalBridge, now: Callable[[], float]) -> None:
    due, count = now(), 0
    while not bridge.is_done:
        late = now() - due
        bridge.run_cycle(max(late, 0.0))
        if late >= 0.0:
            due = max(due + _PERIOD, now())
            count += 1
            if count % _CYCLES_PER_REPORT == 0 and not bridge.has_driver_ended:
                _send_report(sock, bridge)
        left = max(due - now(), 0.0)
        if bridge.has_driver_ended:
            time.sleep(left)
        elif sock.wait(left):  # Received packets are executed at once.
            _receive_packets(sock, bridge)


def _send_report(sock: MessageSocket, bridge: HalBridge) -> None:
    """Send a report.

    If the driver is not reading, this report is skipped.
    """
    try:
        sock.send(bridge.encode_report())
    except BlockingIOError:
        return
    except OSError:
        bridge.has_driver_ended = True


def _receive_packets(sock: MessageSocket, bridge: HalBridge) -> None:
    try:
        for head, numbers in sock.receive():
            bridge.queue_packet(head, numbers)
    except (OSError, EOFError):
        bridge.has_driver_ended = True


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
