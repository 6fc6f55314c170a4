"""Features of a program's parts: name, nominal size, tolerance, corrected offset and sampling."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from app.desk.arithmetic import CHARACTERS, EntryError, value_of
from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet, edited
from app.desk.translation import tr
from app.extras.quality.parts_data import feature_of, row_of
from app.extras.quality.sample_plan import SamplePlan
from app.extras.quality.section import NO_PROGRAM, QualitySection, mark_of, signed_size, size, typed_length
from app.offsets.offset_values import Mode
from app.production.parts_watch import PartsWatch
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.extras.quality.control_charts import QualityError
from core.extras.quality.measured_feature import (
    NAME_LONGEST,
    CorrectedBy,
    Feature,
    FeatureKind,
    check_feature,
)
from core.message import Message
from core.store.production import measured_parts

NEW = Feature("", FeatureKind.DIAMETER, 0.0, 0.0, 0.0, CorrectedBy.TOOL, 1)
FIELDS = (
    "NAME",
    "MEASURED",
    "NOMINAL",
    "UPPER DEVIATION",
    "LOWER DEVIATION",
    "CORRECTED BY",
    "TOOL OR OFFSET NUMBER",
    "EFFECT OF LARGER OFFSET ON SIZE",
    "MEASURE EVERY N PARTS (0: NEVER)",
    "PARTS PER SAMPLE",
)
_OF_OMNITURN = {"CORRECTED BY"}  # D offsets exist only in OmniTurn programs.
_OF_LATHES = {
    "TOOL OR OFFSET NUMBER",
    "EFFECT OF LARGER OFFSET ON SIZE",
}  # DL and DR of a mill are entered in the tool table.
_TURNED = {"MEASURED", "CORRECTED BY", "EFFECT OF LARGER OFFSET ON SIZE"}
_WHOLE = {
    "TOOL OR OFFSET NUMBER": "number",
    "MEASURE EVERY N PARTS (0: NEVER)": "every",
    "PARTS PER SAMPLE": "sample",
}
_LENGTHS = {"NOMINAL": "nominal", "UPPER DEVIATION": "high", "LOWER DEVIATION": "low"}


@dataclass(slots=True)
class Draft:
    """Feature that is being edited. ``id`` is 0 for a new feature."""

    feature: Feature
    id: int = 0
    at: int = 0
    fields: tuple[str, ...] = FIELDS

    @property
    def field(self) -> str:
        """Selected field."""
        return self.fields[self.at]

    def cell(self, field: str, mode: Mode) -> str:
        """Return the text of a field."""
        feature = self.feature
        if field == "NAME":
            return feature.name
        if field == "MEASURED":
            return tr("DIAMETER") if feature.kind is FeatureKind.DIAMETER else tr("LENGTH")
        if field == "CORRECTED BY":
            return tr("TOOL WEAR") if feature.by is CorrectedBy.TOOL else tr("SECONDARY OFFSET")
        if field == "EFFECT OF LARGER OFFSET ON SIZE":
            return tr("LARGER") if feature.grows > 0 else tr("SMALLER")
        if field in _WHOLE:
            return str(getattr(feature, _WHOLE[field]))
        value = getattr(feature, _LENGTHS[field])
        return size(value, mode) if field == "NOMINAL" else signed_size(value, mode)

    def turn(self) -> None:
        """Switch a field with two choices to the other choice."""
        feature = self.feature
        if self.field == "MEASURED":
            diameter = feature.kind is FeatureKind.DIAMETER
            self.feature = replace(feature, kind=FeatureKind.LENGTH if diameter else FeatureKind.DIAMETER)
        elif self.field == "CORRECTED BY":
            tool = feature.by is CorrectedBy.TOOL
            self.feature = replace(feature, by=CorrectedBy.SECONDARY if tool else CorrectedBy.TOOL)
        else:
            self.feature = replace(feature, grows=-feature.grows)

    def take(self, text: str, mode: Mode) -> None:
        """Set the selected field to the typed text. Raises EntryError."""
        field = self.field
        if field == "NAME":
            self.feature = replace(self.feature, name=text.strip().upper())
        elif field in _LENGTHS:
            length = typed_length(value_of(text), mode)
            self.feature = replace(self.feature, **{_LENGTHS[field]: length})  # type: ignore[arg-type]
        else:
            value = value_of(text)
            if value != int(value):
                raise EntryError(Message("{value} is not a whole number", value=f"{value:g}"))
            self.feature = replace(self.feature, **{_WHOLE[field]: int(value)})  # type: ignore[arg-type]


class FeaturesSection(QualitySection):
    """Section with the list of features.

    F2 adds a feature, Enter opens the selected feature, and F6 saves it.
    """

    name = "FEATURES"
    use = "nominal dimension, tolerance, sampling plan"

    def __init__(self, desk: Desk, watch: PartsWatch, plan: SamplePlan) -> None:
        super().__init__(desk, watch)
        self.plan = plan
        self.draft: Draft | None = None

    @property
    def fields(self) -> tuple[str, ...]:
        """Fields of a feature for the language of the machine."""
        absent = {"omniturn": set[str](), "sinumerik": _OF_OMNITURN, "klartext": _OF_OMNITURN | _OF_LATHES}
        return tuple(each for each in FIELDS if each not in absent[self.desk.machine.language])

    @property
    def count(self) -> int:
        """Number of fields of the edited feature, or of features."""
        return len(self.draft.fields) if self.draft is not None else len(self.data.features)

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of features, or of the fields of the edited feature."""
        if self.draft is not None:
            return self._fields(self.draft)
        self.settle()
        mode, rows, lathe = self.mode, [], not self.of_mill
        for each in self.data.features:
            tolerance = f"{signed_size(each.high, mode)}  {signed_size(each.low, mode)}"
            every = tr(Message("every {count} parts", count=each.every)) if each.every else ""
            sample = str(each.sample)
            rows.append(
                Row((each.name, mark_of(each) + size(each.nominal, mode), tolerance,
                     feature_of(each).corrected_by if lathe else "", every, sample))
            )  # fmt: skip
        heads = (
            "NAME",
            Message("NOMINAL {mode}", mode=mode.name),
            "TOLERANCE",
            tr("OFFSET") if lathe else "",
            "MEASURED",
            "SAMPLE",
        )
        waits = (
            tr("NEXT PART WAITS FOR REQUIRED MEASUREMENTS")
            if self.plan.waits
            else tr("NEXT PART DOES NOT WAIT FOR REQUIRED MEASUREMENTS")
        )
        notes = (
            (
                "F2 adds a feature, Enter changes the selected feature, F5 sets whether the "
                "next part waits until the required parts are measured."
            ),
            waits,
        )
        title = Message("FEATURES  ·  {program}", program=self.program) if self.program else "FEATURES"
        shares = (0.24, 0.19, 0.25, 0.1, 0.13, 0.09)
        return Sheet(title, heads, shares, tuple(rows), self.marked, notes=notes, raw=frozenset({0}))

    def _fields(self, draft: Draft) -> Sheet:
        mode = self.mode
        rows = tuple(Row((field, draft.cell(field, mode))) for field in draft.fields)
        turned = draft.field in _TURNED
        question = "" if turned else f"{tr(draft.field)}?"
        way = (
            "Enter accepts the entry and goes to the next field. F6 saves the feature, Esc "
            "discards the changes."
        )
        return Sheet(
            "FEATURE", ("", mode.name), (0.55, 0.45), rows, draft.at, question, self.entry.text,
            (tr("PRESS ENTER TO SWITCH TO THE OTHER VALUE"), way) if turned else (way,),
            raw=frozenset({1}),
        )  # fmt: skip

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys of the list or of the edited feature."""
        if self.draft is not None:
            return {"F6": Key("SAVE", self.keep)}
        return {
            "F2": Key(tr("NEW"), self.new),
            "F3": Key("CHANGE", self.change),
            "F4": Key("REMOVE", self.remove),
            "F5": Key("NO WAIT" if self.plan.waits else "WAIT", self._turn_waits),
        }

    def takes(self, key: str) -> bool:
        """Return whether a character is part of the entry: letters for a name, digits for other fields."""
        draft = self.draft
        if draft is None or draft.field in _TURNED:
            return False
        return len(key) == 1 and (draft.field == "NAME" or key in CHARACTERS)

    def typed(self, key: str) -> bool:
        """Handle a key of the edited feature or of the list."""
        draft = self.draft
        if draft is None:
            return self.moves(key) or (key == "Enter" and self._opened())
        if key in {"Up", "Down"} and not self.entry.text:
            draft.at = max(0, min(len(draft.fields) - 1, draft.at + (1 if key == "Down" else -1)))
        elif key == "Enter":
            self.enter()
        elif self.takes(key) or key in {"Back", "Delete"}:
            self.desk.clear()
            self.entry.text = edited(self.entry.text, key, NAME_LONGEST)
        else:
            return False
        return True

    def _opened(self) -> bool:
        self.change()
        return True

    def take(self, text: str) -> bool:
        """Set the selected field and go to the next one. Raises EntryError."""
        draft = self.draft
        if draft is None:
            return False
        if draft.field in _TURNED:
            draft.turn()
            return True
        if text.strip():
            draft.take(text, self.mode)
        draft.at = min(len(draft.fields) - 1, draft.at + 1)
        return True

    def choose(self, row: int) -> None:
        """Select the touched field. A second touch acts like Enter."""
        if self.draft is None:
            super().choose(row)
        elif row != self.draft.at:
            self.entry.text, self.draft.at = "", row
        else:
            self.enter()

    def act(self) -> bool:
        """Open the selected feature."""
        return self._opened()

    def new(self) -> None:
        """Start a new feature (F2)."""
        if not self.program or self.watch.book.locked:
            self.desk.say(self.watch.book.locked or NO_PROGRAM)
            return
        self.desk.clear()
        self.draft = Draft(NEW, fields=self.fields)

    def change(self) -> None:
        """Edit the selected feature. Its readings remain."""
        row = self.feature
        if row is None:
            self.desk.say(self.missing())
            return
        self.desk.clear()
        self.draft = Draft(feature_of(row), row.id, fields=self.fields)

    def keep(self) -> None:
        """Save the edited feature (F6)."""
        draft = self.draft
        if draft is None:
            return
        try:
            if self.entry.text:
                self.take(self.entry.text)
            self.entry.text = ""
            check_feature(draft.feature)
        except (QualityError, EntryError) as error:
            self.desk.refuse(str(error))
            return
        row = row_of(draft.feature, self.program, draft.id)
        self._write(
            lambda c: measured_parts.save_feature(c, row),
            partial(self._kept, row.name),
            Message("feature {row} saved", row=row.name),
        )

    def _kept(self, name: str) -> None:
        self.draft = None
        self.desk.done(tr(Message("{name} SAVED", name=name)))

    def remove(self) -> None:
        """Stop measuring the selected feature after confirmation (F4)."""
        row = self.feature
        if row is None:
            self.desk.say(self.missing())
            return
        asked = tr("STOP MEASURING {name}? READINGS STAY STORED. Y: STOP   N: CONTINUE")
        done = partial(self.desk.say, tr(Message("{name} REMOVED", name=row.name)))
        self.desk.ask(
            tr(Message(asked, name=row.name)),
            lambda: self._write(
                lambda c: measured_parts.retire_feature(c, row.id),
                done,
                Message("{row} removed", row=row.name),
            ),
        )

    def _write(self, operation: Callable[..., object], done: Callable[[], None], change: str) -> None:
        told = Message("measured features of {program}: {change}", program=self.program, change=change)
        self.watch.book.write(Act.FEATURES, operation, done, self.watch.refuse, told)

    def _turn_waits(self) -> None:
        if not self.program:
            self.desk.say(NO_PROGRAM)
            return
        self.desk.clear()
        if not self.desk.refused(Act.FEATURES):
            self.desk.keep(self.plan.turn_waits)

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.draft is not None:
            return "FILL IN THE FIELDS. F6: SAVE   ESC: CANCEL"
        return self.missing() or ("ENTER: CHANGE FEATURE   F2: NEW FEATURE   ESC: BACK TO LIST")

    def escape(self) -> bool:
        """Cancel the entry, or else the edited feature."""
        if super().escape():
            return True
        open_one, self.draft = self.draft is not None, None
        return open_one

    def left(self) -> None:
        """Cancel the edited feature when the section closes."""
        super().left()
        self.draft = None
