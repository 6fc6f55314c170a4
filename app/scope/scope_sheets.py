"""Tables next to the scope's curves: all signals, the trigger, and the records on the disk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from app.desk.arithmetic import EntryError, line_of, value_of
from app.desk.pages.sheet import STEPS, Entry, Key, Row, Sheet, refused
from app.desk.status import formats
from app.desk.translation import tr
from app.scope.scope_model import NO_SAMPLES, Scope, Side
from app.scope.signals import Signal
from app.scope.time_window import When

_RELEASE, _SIGNAL, _LEVEL, _PLACE = range(4)  # rows of the trigger


@dataclass(slots=True)
class ScopeSheets:
    """Tables of the scope page. Enter or a second touch executes the selected row."""

    scope: Scope
    marked: dict[Side, int] = field(default_factory=dict)
    entry: Entry = field(default_factory=Entry)

    @property
    def at(self) -> int:
        """Index of the selected row."""
        return max(0, min(self.marked.get(self.scope.side, 0), self.count - 1))

    @property
    def count(self) -> int:
        """Number of rows."""
        scope = self.scope
        return {
            Side.READINGS: len(scope.shown),
            Side.CURVES: len(scope.signals),
            Side.TRIGGER: 4,
            Side.FILES: len(scope.shelf.files),
        }[scope.side]

    def open(self, side: Side) -> None:
        """Open a table. The same table again returns to the readings."""
        self.scope.desk.clear()
        self.entry.text = ""
        self.scope.side = Side.READINGS if self.scope.side is side else side
        if self.scope.side is Side.FILES:
            self.scope.list_files()

    def sheet(self) -> Sheet:
        """Return the present table."""
        side = self.scope.side
        if side is Side.CURVES:
            return self._curves()
        return self._trigger() if side is Side.TRIGGER else self._files()

    def _curves(self) -> Sheet:
        scope = self.scope
        metric = scope.metric
        rows = tuple(
            Row((each.title, each.quantity.unit(metric)), each.key in scope.chosen) for each in scope.signals
        )
        notes = (tr("Velocities and ripple are calculated over the time shown next to their names."),)
        return Sheet(tr("CURVES"), ("", ""), (0.78, 0.22), rows, self.at, notes=notes, raw=frozenset({0}))

    def _trigger(self) -> Sheet:
        scope = self.scope
        trigger, signal = scope.trigger, self._signal
        what, unit = "", ""
        if trigger.when.by_level and signal is not None:
            quantity = signal.quantity
            unit = quantity.unit(scope.metric)
            what = formats.fixed(trigger.level * quantity.scale(scope.metric), quantity.places(scope.metric))
        elif trigger.when is When.LINE:
            what = str(trigger.line)
        rows = (
            Row(("TRIGGER EVENT", tr(trigger.when.value))),
            Row(("SIGNAL", signal.title if trigger.when.by_level and signal is not None else "")),
            Row(("LINE" if trigger.when is When.LINE else "LEVEL", f"{what} {unit}".strip())),
            Row(("TRIGGER POSITION IN WINDOW", formats.percent(trigger.before))),
        )
        asked = self.at == _LEVEL and bool(what)
        return Sheet(
            tr("TRIGGER") + (f"  ·  {scope.trigger_words}" if scope.trigger_words else ""),
            ("", ""),
            (0.45, 0.55),
            rows,
            self.at,
            question=("LINE?" if trigger.when is When.LINE else "LEVEL?") if asked else "",
            text=self.entry.text,
            notes=("The trigger freezes the curves only once.",),
            raw=frozenset({1}),
        )

    def _files(self) -> Sheet:
        files = self.scope.shelf.files
        rows = tuple(
            Row((each.path.stem, each.when, each.size_words), self._lit(each.path.name)) for each in files
        )
        notes = () if files else (tr("No scope records yet. F2 saves the current view."),)
        heads = (tr("NAME"), tr("SAVED ON"), tr("SIZE"))
        return Sheet(tr("RECORDS"), heads, (0.55, 0.3, 0.15), rows, self.at, notes=notes, raw=frozenset({0}))

    def _lit(self, name: str) -> bool:
        return name in {self.scope.name, self.scope.over_name}

    @property
    def _signal(self) -> Signal | None:
        found = (each for each in self.scope.signals if each.key == self.scope.trigger.signal)
        return next(found, self.scope.marked_signal)

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys while the records are listed."""
        if self.scope.side is not Side.FILES:
            return {}
        scope = self.scope
        return {
            "F2": Key("SAVE", scope.save),
            "F3": Key("OPEN", self._open),
            "F4": Key("OVERLAY", self._overlay),
            "F5": Key("CSV", scope.write_csv),
            "F8": Key("DELETE", self._delete),
        }

    def _open(self) -> None:
        if self.count:
            self.scope.open(self.scope.shelf.files[self.at])

    def _overlay(self) -> None:
        if self.count:
            self.scope.lay_over(self.scope.shelf.files[self.at])

    def _delete(self) -> None:
        if self.count:
            self.scope.delete(self.scope.shelf.files[self.at])

    @property
    def asks(self) -> bool:
        """Whether a value is to be entered."""
        return self.scope.side is Side.TRIGGER and bool(self._trigger().question)

    def takes(self, key: str) -> bool:
        """Return whether a character is part of the value to be entered."""
        return self.asks and self.entry.takes(key)

    def typed(self, key: str) -> bool:
        """Handle a key: arrows select a row, Enter executes the row, and digits edit the entry."""
        if self.asks and self.entry.type(key):
            self.scope.desk.clear()
            return True
        if key in STEPS and self.count:
            self.entry.text = ""
            self._mark(max(0, min(self.count - 1, self.at + STEPS[key])))
            return True
        if key == "Enter" and self.count:
            self.act()
            return True
        return False

    def _mark(self, row: int) -> None:
        self.marked[self.scope.side] = row
        if self.scope.side is Side.READINGS:
            self.scope.mark(row)

    def choose(self, row: int) -> None:
        """Handle a touch: a curve acts at once, and other rows act on a second touch."""
        if row >= self.count:
            return
        again = row == self.at
        self._mark(row)
        if self.scope.side is Side.CURVES or again:
            self.act()

    def act(self) -> None:
        """Execute the selected row."""
        scope = self.scope
        scope.desk.clear()
        if scope.side is Side.CURVES:
            scope.toggle(scope.signals[self.at])
        elif scope.side is Side.FILES:
            self._open()
        elif scope.side is Side.TRIGGER:
            self._act_on_trigger()

    def _act_on_trigger(self) -> None:
        trigger, row = self.scope.trigger, self.at
        if row == _RELEASE:
            order = list(When)
            following = order[(order.index(trigger.when) + 1) % len(order)]
            signal = self._signal
            name = signal.key if signal is not None else ""
            self.scope.set_trigger(replace(trigger, when=following, signal=name))
        elif row == _SIGNAL and trigger.when.by_level and self.scope.shown:
            names = [each.key for each in self.scope.shown]
            at = names.index(trigger.signal) if trigger.signal in names else -1
            self.scope.set_trigger(replace(trigger, signal=names[(at + 1) % len(names)]))
        elif row == _LEVEL and self.asks and self.entry.text:
            self._enter()
        elif row == _PLACE:
            self.scope.set_trigger(trigger.following_share())

    def _enter(self) -> None:
        """Accept the typed value, or report why the value is invalid."""
        scope, trigger = self.scope, self.scope.trigger
        if trigger.when is When.LINE:
            line = line_of(self.entry.text)
            if line is None:
                self.entry.text = refused(self.entry.text)
                scope.desk.refuse(tr("enter the number of the program line as a whole number, 1 or more"))
                return
            scope.set_trigger(replace(trigger, line=line))
            self.entry.text = ""
            return
        signal = self._signal
        scale = signal.quantity.scale(scope.metric) if signal is not None else 1.0
        try:
            scope.set_trigger(replace(trigger, level=value_of(self.entry.text) / scale))
        except EntryError as error:
            self.entry.text = refused(self.entry.text)
            scope.desk.refuse(str(error))
            return
        self.entry.text = ""

    def escape(self) -> bool:
        """Go back one step. Return False at the readings without cursors."""
        scope = self.scope
        if scope.desk.notice:
            scope.desk.clear()
        elif self.entry.text:
            self.entry.text = ""
        elif scope.side is not Side.READINGS:
            scope.side = Side.READINGS
        elif scope.cursors.shown:
            scope.cursors.at = -1
        else:
            return False
        return True

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.scope.side is Side.READINGS:
            if self.scope.cursors.shown:
                return tr("ARROWS: MOVE CURSOR   TAB: OTHER CURSOR   CTRL+ARROWS: PAN")
            if not self.scope.has_samples:
                return NO_SAMPLES
            return tr("UP/DOWN: SELECT CURVE   Z: ZOOM   CTRL+ARROWS: PAN, STRETCH")
        if self.scope.side is Side.CURVES:
            return tr("ENTER: SHOW OR HIDE CURVE   ESC: BACK TO CURVES")
        if self.scope.side is Side.TRIGGER:
            return tr("ENTER: NEXT CHOICE   DIGITS: TYPE LEVEL   ESC: BACK")
        return tr("F2: SAVE THE VIEW   ENTER: OPEN RECORD   ESC: BACK TO CURVES")
