"""When a thread pass may begin: always at the same angle of the spindle, so that all passes track."""

from __future__ import annotations

import math
from collections.abc import Callable

from core.executor.alarms import TroubleError
from core.executor.bench import Bench


def index_start(bench: Bench) -> Callable[[float], float]:
    """For a moment, the first one not before it at which the spindle's index passes.

    Predicted from the encoder's count and the measured speed; the slides then accelerate the same way in
    every pass. Raises TroubleError without an encoder.
    """

    def start(earliest: float) -> float:
        read = bench.ports.spindle.angle()
        speed = abs(bench.spindle.measured) / 60.0
        if read is None or speed <= 0.0:
            raise TroubleError("program", "a thread needs a turning spindle with an encoder")
        t, turns = read
        sign = math.copysign(1.0, bench.spindle.measured)
        ahead = sign * turns + speed * (earliest - t)
        return earliest + (math.ceil(ahead - 1e-9) - ahead) / speed

    return start
