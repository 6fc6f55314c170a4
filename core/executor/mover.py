"""The moving part of a cycle: stretches from rest to rest under overrides, single block and read-ahead."""

from __future__ import annotations

from core.executor.bench import Bench
from core.executor.feed import BlockFeed
from core.executor.moving import Progress
from core.executor.player import Player
from core.executor.retreat import Retreat
from core.executor.stretch import Scales
from core.interpreter.elementary_blocks import Block, Kind


class Mover:
    """``Moving`` by setpoints: plans with the overrides and switches of now, and again when they change."""

    def __init__(self, bench: Bench, player: Player) -> None:
        self._bench = bench
        self.player = player
        self._scales = Scales()
        self._single = False  # the present plan stops at the end of a block
        self._single_from: int | None = None  # the block from which on it may stop
        self._last: int | None = None  # the block at whose end the present plan stops
        self._retreat: Retreat | None = None

    @property
    def active(self) -> bool:
        """Whether there is a stretch at all."""
        return self.player.active

    @property
    def moving(self) -> bool:
        """Whether anything still moves."""
        return self.player.active and not self.player.at_rest()

    @property
    def block(self) -> Block | None:
        """The block being played."""
        return self.player.block(self._bench.now)

    @property
    def following(self) -> Block | None:
        """The block behind it, when it belongs to the stretch."""
        return self.player.following()

    @property
    def complete(self) -> bool:
        """Whether what is queued ends where the stretch does."""
        left = self._bench.switches.single_block and self.player.steps_left()
        return self.player.complete() and not left

    @property
    def ended_with(self) -> Block | None:
        """At the end of the stretch: its last block."""
        return self.player.ended_with()

    @property
    def starving(self) -> float:
        """When the tail begins although the plan goes on."""
        return self.player.starving

    def begin(self, blocks: list[Block]) -> None:
        """A new stretch, from rest; a thread pass is tied to the spindle."""
        self._single_from = None
        if blocks[0].kind is Kind.THREAD:
            self.player.begin_pass(blocks, self._bench.spindle.turns, self._bench.ports.gear)
        else:
            self.player.begin(blocks, self._bench.spindle.highest)
        self.go()

    def go_on(self, behind: Block | None) -> None:
        """From rest within the stretch; with single block to the end of the block after this one."""
        self._single_from = behind.n + 1 if behind else None
        self.go()

    def go(self, *, soon: bool = True) -> None:
        """Plan on from the present state. Raises MotionError and DriverError."""
        bench, player = self._bench, self.player
        self._scales = self.wanted()
        self._single = bench.switches.single_block
        self._last = self._last_block() if self._single else None
        if not self._single:
            self._single_from = None
        player.go(self._scales, self._last, soon=soon)

    def progress(self, feed: BlockFeed) -> Progress:
        """Follow switches and overrides, take read-ahead blocks in, and say how far it is."""
        player = self.player
        if not player.active:
            return Progress.DONE
        if self.wanted() != self._scales or self._bench.switches.single_block != self._single:
            self.go()
        if self.moving:
            self._refill(feed)
            return Progress.MOVING
        if self._last is not None and player.step_over(self._last):
            return Progress.BLOCK_END if player.steps_left() else Progress.DONE
        if self._last is None and player.complete():
            return Progress.DONE
        if not (self._scales.feed and self._scales.rapid and self._scales.turn):
            return Progress.STILL
        self.go()
        return Progress.MOVING

    def keep_up(self) -> None:
        """Keep the queue filled while the slides come to rest."""
        self.player.extend(self._bench.now)

    def hold(self) -> None:
        """Come to rest as soon as the path allows; a thread pass ends behind its pull-out."""
        self.player.hold(self.wanted())

    def brake(self) -> None:
        """Come to rest at once on the path, thread or not."""
        self.player.brake()

    def let_stop(self) -> None:
        """Leave the tail in the queue as it is."""
        self.player.let_stop()

    def release(self) -> bool:
        """Give a thread pass back that still waits for its index; False when it moves."""
        return self.player.release()

    def retreat(self, block: Block) -> None:
        """Begin to leave a thread whose spindle is lost."""
        self._retreat = Retreat(self._bench, self.player, block)

    def retreated(self) -> None:
        """At rest: draw back, or be done. Raises TroubleError("thread-lost") in the end."""
        if self._retreat is not None:
            self._retreat.step()

    def forget(self) -> None:
        """The stretch is over, or nothing of it holds any more."""
        self._retreat = None
        self.player.forget()

    def wanted(self) -> Scales:
        """The scales of now. A rapid is never faster than its rate; G95 follows the spindle's pot."""
        feed = self._bench.feed_override
        return Scales(feed, min(feed, 1.0), round(self._bench.spindle.override, 2))

    def _last_block(self) -> int | None:
        now = self._bench.now
        current = self.player.block(now)
        first = self._single_from if self._single_from is not None else (current.n if current else None)
        last = self.player.settle_at(first, now)
        self._single_from = first if last is None else last
        return last

    def _refill(self, feed: BlockFeed) -> None:
        """Read-ahead blocks join the stretch before its braking end comes near."""
        player, now = self.player, self._bench.now
        left = player.planned_to - now
        ahead = self._bench.machine.timing.lookahead
        wanted = feed.seconds > 0.25 * ahead or feed.dry or left < 0.75 * ahead
        if feed.pending and wanted and left < 1.5 * ahead:
            player.add(feed.take())
            self.go(soon=False)
        player.extend(now)
        if player.out_of_step:
            self._bench.say(
                "thread",
                "the spindle changed its speed faster than the slides could follow: check the thread",
            )
