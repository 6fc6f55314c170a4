"""Order of presses, from which the key watcher detects presses that the screen has not handled yet."""

from __future__ import annotations

_TIME_BITS = 0xFFFFFFFF  # Time of the X server in ms in a press number. It overflows after 49 days.


def is_press_handled(press: int, handled_press: int) -> bool:
    """Return whether a press was handled if the screen handles presses in order up to ``handled_press``.

    Both are press numbers. The result is False if a number is 0 and therefore unknown.
    """
    if not press or not handled_press:
        return False
    later_ms = (handled_press - press) & _TIME_BITS
    return press == handled_press or 0 < later_ms <= _TIME_BITS // 2


class HandledPresses:
    """Record of the last press whose effects the screen has completed.

    An effect can be completed shortly after the event, for example when a field opens. A press therefore
    counts as handled after two frames. A mouse press or touch can also have an effect when it is released.
    Therefore, frames while ``is_pointer_down`` is set do not count.
    """

    def __init__(self) -> None:
        self.handled_press = 0  # Press number, or 0 if no press was handled.
        self.received_press = 0  # Number of the last press whose event has arrived, or 0.
        self.is_pointer_down = False  # A mouse button or a touch is down, according to the events.
        self._waiting = 0

    def record_press(self, press: int) -> None:
        """Record that the event of a press has arrived."""
        self.received_press = press or self.received_press

    def complete_frame(self) -> None:
        """Record that a frame is complete."""
        if self.is_pointer_down:
            return
        self.handled_press, self._waiting = self._waiting, self.received_press
