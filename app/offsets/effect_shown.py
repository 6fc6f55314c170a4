"""Which effect is shown on an offset page: of what is being typed, else of the last change."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeVar

from app.desk.desk import Desk
from app.desk.formats import length
from app.desk.translation import tr
from app.offsets.effect import Compared, Effect, Tables
from app.offsets.offset_book import secondary_offsets, tool_offsets
from app.offsets.offset_history import Ledger
from core.store.store_rows import Change, Kind, SecondaryRow, ToolRow

R = TypeVar("R", ToolRow, SecondaryRow)
Rows = tuple[Mapping[int, ToolRow], Mapping[int, SecondaryRow]]


@dataclass(slots=True)
class ShownEffect:
    """F6: the whole path with the place of the greatest change, then that place, then the table again."""

    desk: Desk
    ledger: Ledger
    proposed: Callable[[], Rows]  # the tables with what is being typed
    open: bool = False
    near: bool = False  # the place of the greatest change, so near that it is seen

    @property
    def effect(self) -> Effect | None:
        """Who draws."""
        return self.desk.attached(Effect)

    def turn(self) -> None:
        """F6."""
        if not self.open:
            self._open()
        elif not self.near and self.pictures is not None and not self.pictures.same:
            self.near = True
        else:
            self.close()

    def _open(self) -> None:
        effect, job = self.effect, self.desk.session.now.job
        if effect is None or job is None:
            self.desk.say(tr("LOAD A PROGRAM FIRST: THE EFFECT IS SHOWN ON ITS PATH"))
            return
        pair = self._pair()
        if pair is None:
            self.desk.say(tr("NOTHING HAS CHANGED HERE YET: TYPE A VALUE OR CHANGE ONE, THEN PRESS F6"))
            return
        self.desk.clear()
        effect.ask(job, *pair)
        self.open, self.near = True, False

    def _pair(self) -> tuple[Tables, Tables] | None:
        """Before and after: of the entry, where it would change something, else of the last change."""
        book = self.ledger.book
        tools, secondary = self.proposed()
        now = _tables(book.tools, book.secondary)
        typed = _tables(tools, secondary)
        if typed != now:
            return now, typed
        if not self.ledger.last:
            return None
        if self.ledger.kind is Kind.TOOL:
            return _tables(_before(book.tools, self.ledger.last, ToolRow), book.secondary), now
        return _tables(book.tools, _before(book.secondary, self.ledger.last, SecondaryRow)), now

    def close(self) -> None:
        """The table again."""
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
        mode = self.ledger.mode
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
