"""Jog on a controller that plans by itself: the lease is the way that it has been given."""

from __future__ import annotations

import math

from core.block_port import BlockSink
from core.executor import ride
from core.executor.bench import Bench
from core.executor.jog import LONGEST_LEASE, Jogger


def jogger_of(bench: Bench) -> Jogger:
    """By setpoints, or by the controller's own jog."""
    return Jogger(bench) if bench.ports.blocks is None else BlockJogger(bench, bench.ports.blocks)


class BlockJogger(Jogger):
    """Same questions and refusals; the controller moves."""

    def __init__(self, bench: Bench, sink: BlockSink) -> None:
        super().__init__(bench)
        self._sink = sink

    def refusal(self, name: str, velocity: float, lease: float) -> str:
        """Why this jog is refused; empty when it may begin or go on."""
        return super().refusal(name, velocity, lease) or ("" if self.axis else self._unready())

    def step_refusal(self, name: str, distance: float, speed: float) -> str:
        """Why this step is refused; empty when it may begin."""
        return super().step_refusal(name, distance, speed) or self._unready()

    def step(self, name: str, distance: float, speed: float) -> None:
        """Begin a step from rest. Raises DriverError."""
        index, top = self._speed(name, speed)
        self._sink.jog_to(name, self._bench.sample.demand[index] + distance, top)
        self._axis, self.stepping = index, True

    def move(self, name: str, velocity: float, lease: float) -> bool:
        """Begin or renew; False when there is no way to go in that direction. Raises DriverError."""
        index, top = self._speed(name, abs(velocity))
        axis = self._bench.machine.axes[index]
        limits = axis.travel if self._bench.sample.homed[index] else None
        if limits is not None:
            limits = limits[0] + ride.MARGIN, limits[1] - ride.MARGIN
        moves = self._sink.jog(name, math.copysign(top, velocity), min(lease, LONGEST_LEASE), limits)
        if moves:
            self._axis = index
        return moves

    def stop(self) -> None:
        """The lease is given back, or taken away; a step ends short, and that is said when it rests."""
        if self._axis < 0:
            return
        self._short = self._short or self.stepping
        self.stepping = False
        self._sink.jog_stop()

    def over(self) -> bool:
        """Whether it has come to rest."""
        if not self._sink.state().resting:
            return False
        self.ended()
        return True

    def _speed(self, name: str, speed: float) -> tuple[int, float]:
        index = self._bench.ports.axes.axes.index(name)
        axis = self._bench.machine.axes[index]
        return index, min(speed, self.top(axis, self._bench.sample.homed[index]))

    def _unready(self) -> str:
        state = self._sink.state()
        return state.hindrance or ("" if state.resting else "the controller is still moving")
