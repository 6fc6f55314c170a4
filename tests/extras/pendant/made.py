"""A device that speaks as the kernel does, through a pipe: ``struct input_event``, and what is pressed."""

from __future__ import annotations

import os
import struct
from collections.abc import Mapping

from app.extras.pendant.driver.input_devices import AxisRange
from app.extras.pendant.driver.pendant_table import parse_button_name, parse_wheel_name

# Written down from the kernel's header, and not from the reader that is tested.
EVENT = struct.Struct("@llHHi")
SYN, KEY, REL, ABS = 0, 1, 2, 3
REPORT, DROPPED = 0, 3
BTN_A, BTN_B, BTN_0, REL_DIAL, ABS_HAT0X = 0x130, 0x131, 0x100, 7, 0x10


class Peer:
    """``EventSource`` on the reading end of a pipe; a test presses and turns at the other."""

    def __init__(self, ranges: Mapping[int, AxisRange] | None = None) -> None:
        self._read, self._write = os.pipe()
        os.set_blocking(self._read, False)
        self.pressed: set[int] = set()
        self._ranges = dict(ranges or {})
        self.now = 0.0
        self.closed = False

    # --- what the reader asks

    def read(self) -> bytes:
        try:
            return os.read(self._read, 4096)
        except BlockingIOError:
            return b""

    def fileno(self) -> int:
        return self._read

    def read_pressed_keys(self) -> frozenset[int]:
        return frozenset(self.pressed)

    def read_axis_ranges(self) -> Mapping[int, AxisRange]:
        return self._ranges

    def close(self) -> None:
        self.closed = True
        os.close(self._read)

    # --- what a hand does

    def send(self, *events: tuple[int, int, int], ago: float = 0.0, report: bool = True) -> None:
        t = self.now - ago
        seconds, micro = divmod(round(t * 1e6), 1_000_000)
        told = [*events, (SYN, REPORT, 0)] if report else [*events]
        os.write(self._write, b"".join(EVENT.pack(seconds, micro, *event) for event in told))

    def key(self, code: int, down: bool, ago: float = 0.0) -> None:
        (self.pressed.add if down else self.pressed.discard)(code)
        self.send((KEY, code, int(down)), ago=ago)

    def turn(self, counts: int, ago: float = 0.0) -> None:
        self.send((REL, REL_DIAL, counts), ago=ago)

    def pull(self) -> None:
        """The plug."""
        os.close(self._write)


BUTTONS = {
    "jog_x_plus": parse_button_name("BTN_A"),
    "hold": parse_button_name("BTN_B"),
    "wheel_x": parse_button_name("BTN_0"),
    "jog_z_plus": parse_button_name("ABS_HAT0X+"),
    "jog_z_minus": parse_button_name("ABS_HAT0X-"),
}
BOUND = {name: control for name, control in BUTTONS.items() if control is not None}
WHEEL = parse_wheel_name("REL_DIAL")
HAT = {ABS_HAT0X: AxisRange(-1, 1, 0)}
