"""Pins of a board without the board: ``/usr/bin/python3 board_stand_in.py PINS.json PREFIX`` until ended.

What the file says to be on is read again at a SIGUSR1.
"""

import json
import signal
import sys
from pathlib import Path
from typing import Any


def main(path: str, prefix: str) -> None:
    """Every pin and parameter of the file that begins so, doing nothing but being on or off."""
    import hal  # noqa: PLC0415  of the system's Python

    kinds = {"float": hal.HAL_FLOAT, "bit": hal.HAL_BIT, "s32": hal.HAL_S32, "u32": hal.HAL_U32}
    ways = {"IN": hal.HAL_IN, "OUT": hal.HAL_OUT, "IO": hal.HAL_IO}
    said = json.loads(Path(path).read_text(encoding="utf-8"))
    part: Any = hal.component(f"stand-in-{prefix}", prefix)
    for name, kind, way in said["pins"]:
        if not name.startswith(f"{prefix}."):
            continue
        if way == "RW":
            part.newparam(name.removeprefix(f"{prefix}."), kinds[kind], hal.HAL_RW)
        else:
            part.newpin(name.removeprefix(f"{prefix}."), kinds[kind], ways[way])
    outputs = [name for name, kind, way in said["pins"] if kind == "bit" and way in {"OUT", "IO"}]

    def switch(*_signal: object) -> None:
        on = json.loads(Path(path).read_text(encoding="utf-8"))["on"]
        for name in outputs:
            if name.startswith(f"{prefix}."):
                part[name.removeprefix(f"{prefix}.")] = name in on

    signal.signal(signal.SIGUSR1, switch)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    switch()
    part.ready()
    while True:
        signal.pause()


if __name__ == "__main__":
    main(*sys.argv[1:])
