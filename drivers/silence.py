"""Time limits for the silence of another process, and the stop that a silent control triggers.

This module uses only the standard library, because the HAL bridge runs under the system's Python.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

# Seconds without a message, by the process that waits for it and the process that is silent.
HOST_CONTROL_TIMEOUT_S = 0.2  # The driver host waits for the control, which sends a request in each tick.
HOST_SLEEP_TIMEOUT_S = 0.5  # The same while the control sleeps and nothing is on.
CONTROL_HOST_TIMEOUT_S = 0.5  # The control waits for a reply of the driver host, which needs milliseconds.
BRIDGE_DRIVER_TIMEOUT_S = 0.25  # The HAL bridge waits for its driver, which sends a heartbeat in each cycle.
DRIVER_BRIDGE_TIMEOUT_S = 0.15  # The driver waits for the bridge, which sends a report every 4 ms.
BRIDGE_THREAD_TIMEOUT_S = 0.25  # The bridge waits for a sample of HAL's servo thread.
CONTROL_SCREEN_TIMEOUT_S = 3.0  # The control waits for the screen.
SCREEN_ALIVE_INTERVAL_S = 0.25  # Seconds between two signs of life of the screen.
# The screen ends a silent control after this time; no setpoint queue is longer, so the axes are at rest,
# and a driver host has switched spindle and outputs off.
SCREEN_CONTROL_TIMEOUT_S = 5.0
MAX_STEP_S = 0.05  # Maximum in s that one check counts, so that a delay of this process is not counted.
_SPINDLE_STOP_S = 8.0  # Maximum wait in s for a spindle to brake.


class SilenceTimer:
    """Timer of the time since the last message of another process.

    Each check adds at most ``max_step_s`` seconds, so that a delay of this process is not mistaken for a
    silence of the other process.
    """

    def __init__(self, timeout_s: float, now: float = 0.0, max_step_s: float = math.inf) -> None:
        self.timeout_s = timeout_s
        self._checked_at, self._silence_s, self._max_step_s = now, 0.0, max_step_s

    def hear(self, now: float) -> None:
        """End the silence, because a message has arrived."""
        self._checked_at, self._silence_s = now, 0.0

    def measure(self, now: float) -> float:
        """Return the duration of the silence in seconds, without updating the timer."""
        return self._silence_s + min(now - self._checked_at, self._max_step_s)

    def check(self, now: float) -> bool:
        """Count the time since the last check, and return whether the silence exceeds the limit."""
        self._checked_at, self._silence_s = now, self.measure(now)
        return self.is_exceeded

    @property
    def is_exceeded(self) -> bool:
        """Return whether the silence exceeded the limit at the last check."""
        return self._silence_s > self.timeout_s


@dataclass(frozen=True, slots=True)
class StopSteps:
    """The steps that stop a machine whose control is silent."""

    is_at_rest: Callable[[], bool]  # Whether the setpoint queue has ended.
    brake_waiting_cam: Callable[[], object]  # Brake axes that follow a spindle that is stopped.
    switch_off: Callable[[], object]  # Switch off the spindle and set the outputs to their safe states.
    remove_power: Callable[[], object]
    is_spindle_stopped: Callable[[], bool]


class SilenceStop(SilenceTimer):
    """Timer that stops the machine if its control is silent.

    The setpoint queue is executed to its end, where the axes are at rest. Then the spindle and the outputs
    are switched off. If the control has ended, the drives are also switched off. The stop is then complete
    when the spindle is at standstill.
    """

    def __init__(self, timeout_s: float, now: float, steps: StopSteps) -> None:
        super().__init__(timeout_s, now)
        self._steps = steps
        self._switched_off_at: float | None = None
        self.is_done = False

    @property
    def has_switched_off(self) -> bool:
        """Return whether the spindle and the outputs were switched off in this silence."""
        return self._switched_off_at is not None

    def advance(self, now: float, *, has_ended: bool) -> None:
        """Execute the next steps of the stop if the control is silent for too long or has ended."""
        steps = self._steps
        if not (self.check(now) or has_ended):
            self._switched_off_at = None
        elif not steps.is_at_rest():
            steps.brake_waiting_cam()
        else:
            if self._switched_off_at is None:
                self._switched_off_at = now
                steps.switch_off()
            if has_ended and not self.is_done:
                steps.remove_power()
                # Closing removes the spindle's power, so a turning spindle would coast.
                self.is_done = steps.is_spindle_stopped() or now - self._switched_off_at > _SPINDLE_STOP_S
