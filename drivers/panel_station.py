"""An operator station on the screen, for machines that have none of their own."""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Callable

from core.ports import Clock, Station, StationState
from drivers.simulated.station_panel import Panel

_WINDOW, _PULSE = 0.5, 0.1  # s, of the two-hand relay that the screen stands for


class PanelStation:
    """Hands on one side, ``core.ports.Station`` on the other; any thread may call.

    ``estop`` reads the real E-stop where the machine has an input for it; it is pressed when either is.
    ``wired`` is a station of which there is only a handwheel: it counts on.
    """

    def __init__(self, clock: Clock, estop: Callable[[], bool], wired: Station | None = None) -> None:
        self._clock = clock
        self._estop = estop
        self._wired = wired
        self._lock = threading.Lock()
        self._panel = Panel(_WINDOW, _PULSE, seed=0)

    def snapshot(self) -> StationState:
        """The station now."""
        with self._lock:
            state = self._panel.state(self._clock.now())
        wired = self._wired.snapshot() if self._wired is not None else StationState()
        return dataclasses.replace(
            state,
            estop=state.estop or self._estop(),
            handwheel=state.handwheel + wired.handwheel,
            age=max(state.age, wired.age),
        )

    def press_left(self) -> None:
        """Left palm button down."""
        self._palm("left", down=True)

    def release_left(self) -> None:
        """Left palm button up."""
        self._palm("left", down=False)

    def press_right(self) -> None:
        """Right palm button down."""
        self._palm("right", down=True)

    def release_right(self) -> None:
        """Right palm button up."""
        self._palm("right", down=False)

    def press_hold(self) -> None:
        """Feed hold button down."""
        with self._lock:
            self._panel.hold(True, self._clock.now())

    def release_hold(self) -> None:
        """Feed hold button up."""
        with self._lock:
            self._panel.hold(False, self._clock.now())

    def press_estop(self) -> None:
        """The screen's E-stop: the control stops everything it can. It is no safety device."""
        with self._lock:
            self._panel.estop = True

    def release_estop(self) -> None:
        """Free again."""
        with self._lock:
            self._panel.estop = False

    def set_spindle_auto(self, auto: bool) -> None:
        """Spindle AUTO/OFF."""
        with self._lock:
            self._panel.spindle_auto = auto

    def set_spindle_pot(self, fraction: float) -> None:
        """Spindle override, 0…1."""
        with self._lock:
            self._panel.spindle_pot = min(max(fraction, 0.0), 1.0)

    def set_feed_pot(self, fraction: float) -> None:
        """Feed override, 0…1.5."""
        with self._lock:
            self._panel.feed_pot = min(max(fraction, 0.0), 1.5)

    def turn_handwheel(self, counts: int) -> None:
        """Turn the drawn handwheel on by so many counts, signed."""
        with self._lock:
            self._panel.handwheel += counts

    def _palm(self, which: str, *, down: bool) -> None:
        with self._lock:
            relay, now = self._panel.relay, self._clock.now()
            if down:
                relay.press(which, now)
            else:
                relay.release(which, now)
