"""R parameters of SINUMERIK programs: what the operator sets, and every program begins with."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from app.desk.arithmetic import EntryError, value_of
from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet
from app.desk.persistence import Persistence
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.offsets_in_force import R_PARAMETERS, r_parameters
from app.special.special_functions import FigureFunction
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.language.sinumerik.sinumerik_words import MOST_R, REACH
from core.message import Message
from core.store.store_errors import StoreError


class RParameters(FigureFunction):
    """One row a parameter; a figure that is typed is that of the marked one. The program is proved again."""

    name = "R PARAMETERS"
    use = "R0 to R299 of SINUMERIK programs"

    def __init__(self, desk: Desk, persistence: Persistence, worker: Latest) -> None:
        super().__init__(desk)
        self._persistence, self._worker = persistence, worker
        self.values: dict[int, float] = {}  # of those that have one
        self.opened()

    def opened(self) -> None:
        """Read them anew, after a restore too."""
        if self._worker.busy:
            return  # what is being kept is shown already
        try:
            self.values = r_parameters(self._persistence.setting(R_PARAMETERS))
        except StoreError:
            self.values = {}  # the desk says by itself that nothing is kept

    @property
    def count(self) -> int:
        """R0 to R299."""
        return MOST_R + 1

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """All of them; a dash for one that nobody has set, which counts as 0."""
        values = self.values
        rows = tuple(
            Row((f"R{number}", f"{values[number]:.9g}" if number in values else "–"), number in values)
            for number in range(self.count)
        )
        return Sheet(
            "R PARAMETERS",
            ("", ""),
            (0.4, 0.6),
            rows,
            self.marked,
            question=f"R{self.marked}?",
            text=self.entry.text,
            notes=(
                (
                    "Every SINUMERIK program starts with these values. Values that the program assigns "
                    "apply until the program ends."
                ),
                "A parameter without a value is treated as 0, and a warning is shown.",
            ),
            figures=frozenset({1}),
        )

    def keys(self) -> Mapping[str, Key]:
        """F4 takes the value of the marked one away."""
        return {"F4": Key("CLEAR", self.unset)}

    def typed(self, key: str) -> bool:
        """Figures, Return, and what moves the mark."""
        return super().typed(key) or self.moves(key)

    def unset(self) -> None:
        """The marked one has no value any more."""
        self._keep(self.marked, None)

    def take(self, text: str) -> bool:
        """The typed figure becomes that of the marked parameter. Raises EntryError beyond what one holds."""
        value = value_of(text)
        low, high = REACH["R"]
        if not low <= value <= high:
            raise EntryError(
                tr(Message("R PARAMETERS RANGE FROM {low} TO {high}", low=f"{low:g}", high=f"{high:g}"))
            )
        return self._keep(self.marked, value)

    def _keep(self, number: int, value: float | None) -> bool:
        """Save it, note it in the log, and prove the loaded program again. False while a program runs."""
        if self.desk.refused(Act.ZEROS):
            return False
        if self.desk.snapshot().state in UNDER_WAY:
            self.desk.say(tr("PROGRAM RUNNING. CHANGE R PARAMETERS BETWEEN CYCLES"))
            return False
        before = self.values.pop(number, None)
        if value is not None:
            self.values[number] = value
        kept = {str(each): self.values[each] for each in sorted(self.values)}
        told = f"R{number}: {_told(before)} → {_told(value)}"
        self._worker.queue(
            partial(self._persistence.keep_settings, {R_PARAMETERS: kept or None}),
            lambda _none: self._is_kept(told),
            lambda why: self.desk.say(tr(Message("NOT SAVED: {why}", why=why))),
        )
        return True

    def _is_kept(self, told: str) -> None:
        """Note it in the log, and prove the loaded program again."""
        self._persistence.note_change(told)
        now = self.desk.session.now
        if now.path is None or now.job is None:
            return
        if self.desk.snapshot().state in UNDER_WAY:  # somebody started a cycle meanwhile
            self.desk.rebuilding.wanted = True
        else:
            self.desk.session.load(now.path, now.block_delete)


def _told(value: float | None) -> str:
    return "none" if value is None else f"{value:.9g}"
