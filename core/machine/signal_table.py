"""Signal tower and sounds: what lights, blinks and buzzes for what. One table, for machine and desk."""

from __future__ import annotations

from typing import NamedTuple

RED, AMBER, GREEN, BUZZER = "lamp_red", "lamp_amber", "lamp_green", "lamp_buzzer"
LAMPS = (RED, AMBER, GREEN, BUZZER)
"""Outputs of [io.out] that the control lights by itself, where the machine file has them."""
PREFIX = "lamp_"
HALF = 0.5  # s that a blinking lamp is on, and off


class Signal(NamedTuple):
    """``buzz``: s for which the buzzer sounds at its beginning, by turns where the lamp blinks.

    ``tones``: what the desk plays, Hz, each a fifth of a second.
    """

    lamp: str
    blinks: bool
    buzz: float
    tones: tuple[int, ...]
    use: str


SIGNALS = {
    "estop": Signal(RED, False, 0.0, (440, 440), "E-STOP"),
    "alarm": Signal(RED, True, 3.0, (880, 440, 880, 440), "ALARM"),
    "tool-life": Signal(AMBER, True, 1.0, (660, 660), "TOOL LIFE USED UP, OR PART MEASUREMENT DUE"),
    "stop": Signal(AMBER, True, 1.0, (660, 440), "STOP: FEED HOLD, M00, SINGLE BLOCK"),
    "part": Signal(AMBER, False, 0.5, (523, 659, 784), "PART FINISHED, NO CYCLE RUNNING"),
    "runs": Signal(GREEN, False, 0.0, (), "CYCLE RUNNING"),
}
"""By the kind of what happens, as it is announced (MQTT, web hook) too."""
