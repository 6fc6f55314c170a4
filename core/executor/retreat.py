"""Out of a thread whose spindle is lost: stop along the thread, then draw X back as the pass would have."""

from __future__ import annotations

import dataclasses

from core.executor.alarms import TroubleError
from core.executor.bench import Bench
from core.executor.player import Player
from core.executor.stretch import Scales
from core.interpreter.blocks import Block, Kind

_THERE = 1e-6  # mm


class Retreat:
    """Begins with braking; ``step`` raises TroubleError once X is back."""

    def __init__(self, bench: Bench, player: Player, block: Block) -> None:
        self._bench = bench
        self._player = player
        self._block = block
        self._x = [block, *player.behind(block)][-1].mx  # where the pass would have pulled out to
        player.brake()

    def step(self) -> None:
        """At rest: draw back, or be done. Raises TroubleError("thread-lost") in the end."""
        (x, z, c), _ = self._bench.ports.axes.demand_at(self._bench.now)
        if abs(x - self._x) < _THERE:
            raise TroubleError("thread-lost", line=self._block.line)
        self._player.begin([self._away((x, z, c))], self._bench.spindle.highest)
        self._player.go(Scales())

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
