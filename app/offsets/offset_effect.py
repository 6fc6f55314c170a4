"""Effect of a change of offsets on the path: the loaded program drawn with the old and new offsets.

A changed tool offset moves the real tip. Both paths are therefore drawn in the frame of the old offsets, so
that their distance equals the distance that the tip will move.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from app.desk.background_work import Latest, Watch
from app.desk.status.formats import length
from app.desk.translation import tr
from app.offsets.offset_table import OffsetTable
from app.offsets.offsets_in_force import secondary_offsets, tool_offsets
from core.executor.job import Job
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.message import Message
from core.store.store_rows import Change, Kind, SecondaryRow, ToolRow

if TYPE_CHECKING:
    from app.path.path_picture import Picture
    from core.proving.other_offsets import OtherPart

    # Arguments: the job with old and new offsets. Returns None if the program makes no part.
    ComparePart = Callable[[Job, Job, Watch], OtherPart | None]

NOUGHT = 1e-9  # Millimeters.
R = TypeVar("R", ToolRow, SecondaryRow)


@dataclass(frozen=True, slots=True)
class Tables:
    """Tool offsets and secondary offsets, as the interpreter uses them."""

    tools: Mapping[int, ToolOffset] = field(default_factory=dict)
    secondary: Mapping[int, SecondaryOffset] = field(default_factory=dict)


# Arguments: job, tools that define the frame of the drawing, and progress function.
Draw = Callable[[Job, Mapping[int, ToolOffset], Watch], "Picture"]


@dataclass(frozen=True, slots=True)
class Compared:
    """Two paths in one frame, with the old and the new offsets."""

    before: Picture
    after: Picture
    # Largest distance of corresponding points in mm; inf if the paths have different moves.
    furthest: float = 0.0

    @property
    def same(self) -> bool:
        """Whether the change has no effect on this program."""
        return self.furthest <= NOUGHT


def compared(before: Picture, after: Picture) -> Compared:
    """Return both paths with their largest distance."""
    if len(before.z) != len(after.z) or not np.array_equal(before.stroke, after.stroke):
        return Compared(before, after, float("inf"))
    if not len(before.z):
        return Compared(before, after)
    apart = np.hypot(after.z - before.z, after.x - before.x)
    return Compared(before, after, float(apart.max()))


@dataclass(slots=True)
class Effect:
    """Draws the paths on a worker. The screen reads only ``now``, ``part``, ``busy`` and ``trouble``."""

    draw: Draw
    compare: ComparePart | None = None  # None: parts cannot be compared.
    now: Compared | None = None
    part: OtherPart | None = None
    trouble: str = ""
    worker: Latest = field(default_factory=lambda: Latest("effect"))

    @property
    def busy(self) -> bool:
        """Whether the worker is still drawing. After an error, ``trouble`` gives the reason."""
        self.worker.poll()
        return self.worker.busy

    def ask(self, job: Job, before: Tables, after: Tables) -> None:
        """Draw this program with the old and new offsets. A drawing in progress is canceled."""

        def pair(watch: Watch) -> Compared:
            return compared(*(self.draw(_with(job, each), before.tools, watch) for each in (before, after)))

        self.now, self.part, self.trouble = None, None, ""
        self.worker.ask(pair, self._drawn, self._failed)

    def ask_part(self, compare: ComparePart, job: Job, before: Tables, after: Tables) -> None:
        """Compare the part with the old and new offsets. Work in progress is canceled."""
        self.part, self.trouble = None, ""
        work = partial(compare, _with(job, before), _with(job, after))
        self.worker.ask(work, self._compared, self._failed)

    def _compared(self, part: OtherPart | None) -> None:
        self.part = part
        self.trouble = "" if part is not None else tr("THIS PROGRAM DOES NOT MAKE A PART")

    def _drawn(self, pair: Compared) -> None:
        self.now = pair

    def _failed(self, why: str) -> None:
        self.trouble = why

    def forget(self) -> None:
        """Cancel the drawing in progress, and discard the results."""
        self.worker.give_up()
        self.now, self.part, self.trouble = None, None, ""

    def close(self) -> None:
        """Cancel the drawing in progress, and end the worker."""
        self.worker.close()


def _with(job: Job, tables: Tables) -> Job:
    return replace(job, setup=replace(job.setup, tools=tables.tools, secondary=tables.secondary))


# --- display on the page -----------------------------------------------------------------------------------


@dataclass(slots=True)
class EffectDisplay:
    """The views of the effect: whole path, close-up of the largest change, part features, then the table."""

    table: OffsetTable
    open: bool = False
    near: bool = False  # Close-up of the largest change.
    of_part: bool = False  # Effect on the features of the part.
    _asked: tuple[Tables, Tables] | None = None

    @property
    def effect(self) -> Effect | None:
        """The worker that draws, or None if effects cannot be drawn."""
        return self.table.desk.pages.find(Effect)

    def turn(self) -> None:
        """Handle F6: show the next view."""
        if not self.open:
            self._open()
        elif self.of_part or self.pictures is None or self.pictures.same:
            self.close()
        elif not self.near:
            self.near = True
        else:
            self._open_part()

    def _open_part(self) -> None:
        effect, now = self.effect, self.table.desk.session.now
        if effect is None or effect.compare is None or now.job is None or self._asked is None:
            self.close()
        elif now.picture is not None and now.picture.no_part:
            self.close()
            self.table.desk.say(tr(now.picture.no_part))
        else:
            effect.ask_part(effect.compare, now.job, *self._asked)
            self.of_part = True

    def barred(self) -> str:
        """Return why no effect can be shown now. Empty if it can be, or is shown."""
        if self.open:
            return ""
        if self.effect is None or self.table.desk.session.now.job is None:
            return tr("LOAD A PROGRAM FIRST TO SEE THE EFFECT ON ITS PATH")
        if self._pair() is None:
            return tr("NO CHANGES YET. TYPE OR CHANGE A VALUE, THEN PRESS F6")
        return ""

    def _open(self) -> None:
        effect, job, pair = self.effect, self.table.desk.session.now.job, self._pair()
        if effect is None or job is None or pair is None:
            self.table.desk.say(self.barred())
            return
        self.table.desk.clear()
        effect.ask(job, *pair)
        self.open, self.near, self.of_part, self._asked = True, False, False, pair

    def _pair(self) -> tuple[Tables, Tables] | None:
        """Return the old and new offsets, or None if there is no change to show.

        The change is that of the present entry if it changes a value, else the last change.
        """
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
        self.open = self.near = self.of_part = False
        if self.effect is not None:
            self.effect.forget()

    @property
    def pictures(self) -> Compared | None:
        """The paths to draw now. None while the worker is drawing."""
        effect = self.effect
        return None if not self.open or effect is None or effect.busy else effect.now

    @property
    def part(self) -> OtherPart | None:
        """The part with the old and new offsets. None while the worker is calculating."""
        effect = self.effect
        return None if not self.of_part or effect is None or effect.busy else effect.part

    def _words_of_part(self, effect: Effect) -> str:
        part = self.part
        if effect.trouble:
            return tr(
                Message(
                    "PARTS WITH OLD AND NEW OFFSETS CANNOT BE COMPARED: {why}. F6: SHOW TABLE",
                    why=effect.trouble,
                )
            )
        if part is None:
            return tr("SIMULATING THE PART WITH OLD AND NEW OFFSETS")
        if not part.differing:
            return tr("NO DIAMETER OR SHOULDER ON THE PART CHANGES. F6: SHOW TABLE")
        if part.differing == 1:
            return tr("1 PART FEATURE WILL CHANGE. F6: SHOW TABLE")
        words = tr("{count} PART FEATURES WILL CHANGE. F6: SHOW TABLE")
        return tr(Message(words, count=part.differing))

    @property
    def words(self) -> str:
        """The text of the prompt line that describes the view."""
        effect = self.effect
        return self._words_of_part(effect) if self.of_part and effect is not None else self._words_of_path()

    def _words_of_path(self) -> str:
        effect, pair = self.effect, self.pictures
        if effect is not None and effect.trouble:
            return tr(Message("THE EFFECT CANNOT BE DRAWN: {why}", why=effect.trouble))
        if pair is None:
            return tr("DRAWING THE OLD AND NEW PATHS")
        if pair.same:
            return tr("THE CHANGE DOES NOT AFFECT THE LOADED PROGRAM. F6: SHOW TABLE")
        mode = self.table.mode
        if pair.furthest == float("inf"):
            return tr("THE TWO PATHS HAVE DIFFERENT MOVES. F6: SHOW TABLE")
        far = f"{length(pair.furthest, mode.metric)} {mode.name}"
        if not self.near:
            text = tr("PATHS DIFFER BY {far} (CIRCLED). F6: CLOSE-UP   ESC: TABLE")
            return tr(Message(text, far=far))
        text = tr("PATHS DIFFER BY UP TO {far}. Z: ZOOM   F6: SHOW TABLE")
        if effect is not None and effect.compare is not None:
            text = tr("PATHS DIFFER BY UP TO {far}. Z: ZOOM   F6: EFFECT ON THE PART")
        return tr(Message(text, far=far))


def _tables(tools: Mapping[int, ToolRow], secondary: Mapping[int, SecondaryRow]) -> Tables:
    return Tables(tool_offsets(tools), secondary_offsets(secondary))


def _before(rows: Mapping[int, R], changes: tuple[Change, ...], kind: type[R]) -> dict[int, R]:
    """Return the rows as they were before these changes."""
    undone = dict(rows)
    for change in changes:
        undone.pop(change.number, None)
        if isinstance(change.old, kind):
            undone[change.number] = change.old
    return undone
