"""What a change of offsets does to the path: the loaded program drawn with the offsets before and after.

A tool whose offset changes moves its real tip, so both pictures stand in the frame of the offsets before:
there the path after lies beside the path before by as much as the tip will.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from app.desk.formats import length
from app.desk.latest import Latest, Watch
from app.desk.translation import tr
from app.offsets.offset_book import secondary_offsets, tool_offsets
from app.offsets.offset_table import OffsetTable
from core.executor.job import Job
from core.interpreter.job_setup import SecondaryOffset, ToolOffset
from core.store.store_rows import Change, Kind, SecondaryRow, ToolRow

if TYPE_CHECKING:
    from app.path.path_picture import Picture

NOUGHT = 1e-9  # mm
R = TypeVar("R", ToolRow, SecondaryRow)


@dataclass(frozen=True, slots=True)
class Tables:
    """Both tables of offsets, as the interpreter gets them."""

    tools: Mapping[int, ToolOffset] = field(default_factory=dict)
    secondary: Mapping[int, SecondaryOffset] = field(default_factory=dict)


# Job, the tools in whose frame it is drawn, and whether anybody still wants it.
Draw = Callable[[Job, Mapping[int, ToolOffset], Watch], "Picture"]


@dataclass(frozen=True, slots=True)
class Compared:
    """Two pictures in one frame."""

    before: Picture
    after: Picture
    furthest: float = 0.0  # mm between two points of the same number; infinite where the paths differ in kind

    @property
    def same(self) -> bool:
        """Whether the change does nothing to this program."""
        return self.furthest <= NOUGHT


def compared(before: Picture, after: Picture) -> Compared:
    """The pair, and how far the paths lie apart."""
    if len(before.z) != len(after.z) or not np.array_equal(before.stroke, after.stroke):
        return Compared(before, after, float("inf"))
    if not len(before.z):
        return Compared(before, after)
    apart = np.hypot(after.z - before.z, after.x - before.x)
    return Compared(before, after, float(apart.max()))


@dataclass(slots=True)
class Effect:
    """Draws on a worker; the screen only looks at ``now``, ``busy`` and ``trouble``."""

    draw: Draw
    now: Compared | None = None
    trouble: str = ""
    worker: Latest = field(default_factory=lambda: Latest("effect"))

    @property
    def busy(self) -> bool:
        """Whether the worker is still at it; what went wrong there is ``trouble`` afterwards."""
        self.worker.poll()
        return self.worker.busy

    def ask(self, job: Job, before: Tables, after: Tables) -> None:
        """Draw this program both ways; what was being drawn before is given up."""

        def pair(watch: Watch) -> Compared:
            return compared(*(self.draw(_with(job, each), before.tools, watch) for each in (before, after)))

        self.now, self.trouble = None, ""
        self.worker.ask(pair, self._drawn, self._failed)

    def _drawn(self, pair: Compared) -> None:
        self.now = pair

    def _failed(self, why: str) -> None:
        self.trouble = why

    def forget(self) -> None:
        """Give up what is being drawn, and forget what was drawn."""
        self.worker.give_up()
        self.now, self.trouble = None, ""

    def close(self) -> None:
        """Give up whatever is being drawn and end the worker."""
        self.worker.close()


def _with(job: Job, tables: Tables) -> Job:
    return replace(job, setup=replace(job.setup, tools=tables.tools, secondary=tables.secondary))


# --- on the page -------------------------------------------------------------------------------------------


@dataclass(slots=True)
class EffectDisplay:
    """The whole path with the place of the greatest change, then that place, then the table again."""

    table: OffsetTable
    open: bool = False
    near: bool = False  # the place of the greatest change, so near that it is seen

    @property
    def effect(self) -> Effect | None:
        """The worker that draws; None where nothing is drawn."""
        return self.table.desk.attached(Effect)

    def turn(self) -> None:
        """F6: the next of whole path, greatest change, table."""
        if not self.open:
            self._open()
        elif not self.near and self.pictures is not None and not self.pictures.same:
            self.near = True
        else:
            self.close()

    def _open(self) -> None:
        effect, job = self.effect, self.table.desk.session.now.job
        if effect is None or job is None:
            self.table.desk.say(tr("LOAD A PROGRAM FIRST: THE EFFECT IS SHOWN ON ITS PATH"))
            return
        pair = self._pair()
        if pair is None:
            self.table.desk.say(tr("NOTHING HAS CHANGED HERE YET: TYPE A VALUE OR CHANGE ONE, THEN PRESS F6"))
            return
        self.table.desk.clear()
        effect.ask(job, *pair)
        self.open, self.near = True, False

    def _pair(self) -> tuple[Tables, Tables] | None:
        """Before and after: of the entry, where it would change something, else of the last change."""
        book, last = self.table.book, self.table.history.last
        tools, secondary = self.table.proposed()
        now = _tables(book.tools, book.secondary)
        typed = _tables(tools, secondary)
        if typed != now:
            return now, typed
        if not last:
            return None
        if self.table.kind is Kind.TOOL:
            return _tables(_before(book.tools, last, ToolRow), book.secondary), now
        return _tables(book.tools, _before(book.secondary, last, SecondaryRow)), now

    def close(self) -> None:
        """Show the table again."""
        self.open = self.near = False
        if self.effect is not None:
            self.effect.forget()

    @property
    def pictures(self) -> Compared | None:
        """What to draw now; None while the worker is at it."""
        effect = self.effect
        return None if not self.open or effect is None or effect.busy else effect.now

    @property
    def words(self) -> str:
        """What the picture is, for the prompt line."""
        effect, pair = self.effect, self.pictures
        if effect is not None and effect.trouble:
            return tr("THE EFFECT CANNOT BE DRAWN: {why}").format(why=effect.trouble)
        if pair is None:
            return tr("DRAWING THE PATH BEFORE AND AFTER")
        if pair.same:
            return tr("THIS CHANGE DOES NOTHING TO THE LOADED PROGRAM; F6 SHOWS THE TABLE")
        mode = self.table.mode
        if pair.furthest == float("inf"):
            return tr("THE PATHS DIFFER IN KIND; F6 SHOWS THE TABLE")
        far = f"{length(pair.furthest, mode.metric)} {mode.name}"
        if not self.near:
            text = tr("UP TO {far} APART, AT THE CIRCLE; F6 GOES NEAR, Z ZOOMS, ESC SHOWS THE TABLE")
            return text.format(far=far)
        return tr("UP TO {far} APART; Z ZOOMS, F6 SHOWS THE TABLE").format(far=far)


def _tables(tools: Mapping[int, ToolRow], secondary: Mapping[int, SecondaryRow]) -> Tables:
    return Tables(tool_offsets(tools), secondary_offsets(secondary))


def _before(rows: Mapping[int, R], changes: tuple[Change, ...], kind: type[R]) -> dict[int, R]:
    """The rows as they were before these changes."""
    undone = dict(rows)
    for change in changes:
        undone.pop(change.number, None)
        if isinstance(change.old, kind):
            undone[change.number] = change.old
    return undone
