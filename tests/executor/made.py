"""Elementary blocks made by hand, for what a program cannot say yet or would not say."""

from __future__ import annotations

from core.interpreter.shared.actions import Action, ProgramEnd
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState


class Maker:
    """Appends blocks one after the other from a machine position; lengths mm, X a radius."""

    def __init__(self, at: tuple[float, float] = (0.0, 0.0)) -> None:
        self.blocks: list[Block] = []
        self._x, self._z = at
        self.rpm = 0.0

    def _add(self, kind: BlockKind, x: float, z: float, **more: object) -> Maker:
        block = Block(
            n=len(self.blocks) + 1,
            line=len(self.blocks) + 1,
            kind=kind,
            text=kind.value,
            x0=self._x,
            z0=self._z,
            c0=0.0,
            x=x,
            z=z,
            c=0.0,
            offset_x=0.0,
            offset_z=0.0,
            modal=ModalState(),
            rpm=self.rpm,
            **more,  # type: ignore[arg-type]
        )
        self._x, self._z = x, z
        self.blocks.append(block)
        return self

    def act(self, action: Action) -> Maker:
        return self._add(BlockKind.ACTION, self._x, self._z, action=action)

    def rapid(self, x: float, z: float) -> Maker:
        return self._add(BlockKind.RAPID, x, z, feed=100.0)

    def feed(self, x: float, z: float, feed: float) -> Maker:
        return self._add(BlockKind.FEED, x, z, feed=feed)

    def thread(self, x: float, z: float, lead: float) -> Maker:
        return self._add(BlockKind.THREAD, x, z, feed=lead, per_rev=True)

    def end(self) -> list[Block]:
        self.act(ProgramEnd(reset=True))
        return self.blocks
