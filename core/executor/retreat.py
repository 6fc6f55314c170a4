"""Out of a thread whose spindle is lost: stop along the thread, then draw X back as the pass would have."""

from __future__ import annotations

import dataclasses

from core.executor.alarms import TroubleError
from core.executor.bench import Bench
from core.executor.player import Player
from core.executor.stretch import Scales
from core.interpreter.elementary_blocks import Block, Kind

_THERE = 1e-6  # mm
INCH = 25.4


def _why(bench: Bench) -> str:
    spindle = bench.spindle
    if spindle.why_slow:
        return spindle.why_slow.lower()
    if spindle.measured * spindle.command < 0.0:
        return f"the spindle turned the wrong way, at {abs(spindle.measured):.0f} rpm"
    return f"the spindle fell to {abs(spindle.measured):.0f} of {abs(spindle.command):.0f} rpm"


class Retreat:
    """Begins with braking; ``step`` raises TroubleError once X is back."""

    def __init__(self, bench: Bench, player: Player, block: Block) -> None:
        self._bench = bench
        self._player = player
        self._block = block
        behind = player.behind(block)
        self._x = [block, *behind][-1].mx  # where the pass would have pulled out to
        self._cutting = bool(behind)  # else it was in its pull-out
        self._why = _why(bench)
        player.brake()

    def step(self) -> None:
        """At rest: draw back, or be done. Raises TroubleError("thread-lost") in the end."""
        (x, z, c), _ = self._bench.ports.axes.demand_at(self._bench.now)
        if abs(x - self._x) < _THERE:
            raise TroubleError("thread-lost", self._left(z), self._block.line)
        self._player.begin([self._away((x, z, c))], self._bench.spindle.highest)
        self._player.go(Scales())

    def _left(self, z: float) -> str:
        """Why, and what the thread on the part is now."""
        if not self._cutting:
            return f"{self._why} in the pull-out: the thread is cut, its end runs out short"
        metric = self._block.modal.metric
        at = f"{z - self._block.offset_z:.3f}" if metric else f"{(z - self._block.offset_z) / INCH:.4f}"
        return f"{self._why}: the tool left the thread at Z{at}, behind it this pass is not cut"

    def _away(self, at: tuple[float, float, float]) -> Block:
        """A rapid along X alone from where the slides stand."""
        block = self._block
        return dataclasses.replace(
            block,
            kind=Kind.RAPID,
            per_rev=False,
            x0=at[0] - block.offset_x,
            z0=at[1] - block.offset_z,
            c0=at[2],
            x=self._x - block.offset_x,
            z=at[1] - block.offset_z,
            c=at[2],
            feed=block.modal.rapid_rate,
        )
