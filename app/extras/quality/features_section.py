"""Section of MEASURED PARTS for the features of a part.

Each feature has a name, a size, a tolerance, the offset that it corrects, and a sampling interval.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from app.desk.arithmetic import EXPRESSION_CHARACTERS, InvalidEntryError, evaluate_expression
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow, apply_edit_key
from app.desk.translation import tr
from app.extras.quality.parts_data import make_feature_row, make_measured_feature
from app.extras.quality.sample_plan import SamplePlan
from app.extras.quality.section import (
    NO_PROGRAM_MESSAGE,
    QualitySection,
    convert_entry_to_mm,
    format_deviation,
    format_size,
    get_diameter_symbol,
)
from app.offsets.offset_values import UnitMode
from app.production.parts_watch import ProductionMonitor
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.extras.quality.control_charts import QualityError
from core.extras.quality.measured_feature import (
    MAX_NAME_LENGTH,
    CorrectingOffset,
    FeatureKind,
    MeasuredFeature,
    check_feature,
)
from core.message import Message
from core.store.production import measured_parts

EMPTY_FEATURE = MeasuredFeature("", FeatureKind.DIAMETER, 0.0, 0.0, 0.0, CorrectingOffset.TOOL, 1)
FIELD_NAMES = (
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
class FeatureDraft:
    """Unsaved values of a feature that is being edited.

    ``feature_id`` is 0 for a new feature.
    """

    feature: MeasuredFeature
    feature_id: int = 0
    field_index: int = 0
    field_names: tuple[str, ...] = FIELD_NAMES

    @property
    def selected_field(self) -> str:
        """Return the name of the selected field."""
        return self.field_names[self.field_index]

    def get_field_text(self, field: str, value_mode: UnitMode) -> str:
        """Return the value of a field as display text."""
        feature = self.feature
        if field == "NAME":
            return feature.name
        if field == "MEASURED":
            return tr("DIAMETER") if feature.kind is FeatureKind.DIAMETER else tr("LENGTH")
        if field == "CORRECTED BY":
            return tr("TOOL WEAR") if feature.by is CorrectingOffset.TOOL else tr("SECONDARY OFFSET")
        if field == "EFFECT OF LARGER OFFSET ON SIZE":
            return tr("LARGER") if feature.grows > 0 else tr("SMALLER")
        if field in _WHOLE:
            return str(getattr(feature, _WHOLE[field]))
        value = getattr(feature, _LENGTHS[field])
        return format_size(value, value_mode) if field == "NOMINAL" else format_deviation(value, value_mode)

    def toggle_choice(self) -> None:
        """Switch the selected field from one of its two choices to the other."""
        feature = self.feature
        if self.selected_field == "MEASURED":
            diameter = feature.kind is FeatureKind.DIAMETER
            self.feature = replace(feature, kind=FeatureKind.LENGTH if diameter else FeatureKind.DIAMETER)
        elif self.selected_field == "CORRECTED BY":
            tool = feature.by is CorrectingOffset.TOOL
            self.feature = replace(feature, by=CorrectingOffset.SECONDARY if tool else CorrectingOffset.TOOL)
        else:
            self.feature = replace(feature, grows=-feature.grows)

    def set_field(self, text: str, value_mode: UnitMode) -> None:
        """Set the selected field to the typed text.

        Raises InvalidEntryError if the text is not valid for the field.
        """
        field = self.selected_field
        if field == "NAME":
            self.feature = replace(self.feature, name=text.strip().upper())
        elif field in _LENGTHS:
            length = convert_entry_to_mm(evaluate_expression(text), value_mode)
            self.feature = replace(self.feature, **{_LENGTHS[field]: length})  # type: ignore[arg-type]
        else:
            value = evaluate_expression(text)
            if value != int(value):
                raise InvalidEntryError(Message("{value} is not a whole number", value=f"{value:g}"))
            self.feature = replace(self.feature, **{_WHOLE[field]: int(value)})  # type: ignore[arg-type]


class FeaturesSection(QualitySection):
    """Section with the list of features.

    F2 adds a feature, and Enter opens the selected feature. F6 saves the feature that is being edited.
    """

    name = "FEATURES"
    use = "nominal dimension, tolerance, sampling plan"

    def __init__(self, desk: Desk, parts_watch: ProductionMonitor, sample_plan: SamplePlan) -> None:
        super().__init__(desk, parts_watch)
        self.plan = sample_plan
        self.draft: FeatureDraft | None = None

    @property
    def field_names(self) -> tuple[str, ...]:
        """Return the names of the fields of a feature, which depend on the machine's program language."""
        absent = {"omniturn": set[str](), "sinumerik": _OF_OMNITURN, "klartext": _OF_OMNITURN | _OF_LATHES}
        return tuple(each for each in FIELD_NAMES if each not in absent[self.desk.machine.program_language])

    @property
    def row_count(self) -> int:
        """Return the number of fields while a feature is edited, and otherwise the number of features."""
        return len(self.draft.field_names) if self.draft is not None else len(self.parts_data.features)

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of fields while a feature is edited, and otherwise the table of features."""
        if self.draft is not None:
            return self._fields(self.draft)
        self.limit_selection()
        mode, rows, lathe = self.control_length_unit, [], not self.is_mill
        for each in self.parts_data.features:
            tolerance = f"{format_deviation(each.high, mode)}  {format_deviation(each.low, mode)}"
            every = tr(Message("every {count} parts", count=each.every)) if each.every else ""
            sample = str(each.sample)
            rows.append(
                TableRow((each.name, get_diameter_symbol(each) + format_size(each.nominal, mode), tolerance,
                     make_measured_feature(each).corrected_by if lathe else "", every, sample))
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
            if self.plan.is_measurement_wait_enabled
            else tr("NEXT PART DOES NOT WAIT FOR REQUIRED MEASUREMENTS")
        )
        notes = (
            (
                "F2 adds a feature, Enter changes the selected feature, F5 sets whether the "
                "next part waits until the required parts are measured."
            ),
            waits,
        )
        title = (
            Message("FEATURES  ·  {program}", program=self.program_name) if self.program_name else "FEATURES"
        )
        shares = (0.24, 0.19, 0.25, 0.1, 0.13, 0.09)
        return TableContent(
            title, heads, shares, tuple(rows), self.marked, notes=notes, untranslated_columns=frozenset({0})
        )

    def _fields(self, draft: FeatureDraft) -> TableContent:
        mode = self.control_length_unit
        rows = tuple(TableRow((field, draft.get_field_text(field, mode))) for field in draft.field_names)
        turned = draft.selected_field in _TURNED
        question = "" if turned else f"{tr(draft.selected_field)}?"
        entry_hint = (
            "Enter accepts the entry and goes to the next field. F6 saves the feature, Esc "
            "discards the changes."
        )
        return TableContent(
            "FEATURE", ("", mode.name), (0.55, 0.45), rows, draft.field_index, question, self.entry.text,
            (tr("PRESS ENTER TO SWITCH TO THE OTHER VALUE"), entry_hint) if turned else (entry_hint,),
            untranslated_columns=frozenset({1}),
        )  # fmt: skip

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys for the feature that is being edited, or for the feature list."""
        if self.draft is not None:
            return {"F6": FunctionKey("SAVE", self.save_feature)}
        return {
            "F2": FunctionKey(tr("NEW"), self.add_feature),
            "F3": FunctionKey("CHANGE", self.edit_feature),
            "F4": FunctionKey("REMOVE", self.remove_feature),
            "F5": FunctionKey(
                "NO WAIT" if self.plan.is_measurement_wait_enabled else "WAIT", self._turn_waits
            ),
        }

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the selected field.

        A name accepts any character, and a number accepts the characters of an expression.
        """
        draft = self.draft
        if draft is None or draft.selected_field in _TURNED:
            return False
        return len(key) == 1 and (draft.selected_field == "NAME" or key in EXPRESSION_CHARACTERS)

    def handle_key(self, key: str) -> bool:
        """Handle a key for the feature that is being edited, or for the feature list."""
        draft = self.draft
        if draft is None:
            return self.move_selection(key) or (key == "Enter" and self._opened())
        if key in {"Up", "Down"} and not self.entry.text:
            draft.field_index = max(
                0, min(len(draft.field_names) - 1, draft.field_index + (1 if key == "Down" else -1))
            )
        elif key == "Enter":
            self.submit_entry()
        elif self.accepts_key(key) or key in {"Back", "Delete"}:
            self.desk.clear_prompt_line()
            self.entry.text = apply_edit_key(self.entry.text, key, MAX_NAME_LENGTH)
        else:
            return False
        return True

    def _opened(self) -> bool:
        self.edit_feature()
        return True

    def accept_entry(self, text: str) -> bool:
        """Set the selected field to the typed text, and select the next field.

        Returns whether the text was accepted. Raises InvalidEntryError if the text is not valid for the
        field.
        """
        draft = self.draft
        if draft is None:
            return False
        if draft.selected_field in _TURNED:
            draft.toggle_choice()
            return True
        if text.strip():
            draft.set_field(text, self.control_length_unit)
        draft.field_index = min(len(draft.field_names) - 1, draft.field_index + 1)
        return True

    def choose(self, row: int) -> None:
        """Select the touched row.

        While a feature is edited, a second touch on the same row acts like Enter.
        """
        if self.draft is None:
            super().choose(row)
        elif row != self.draft.field_index:
            self.entry.text, self.draft.field_index = "", row
        else:
            self.submit_entry()

    def activate_selected_row(self) -> bool:
        """Start editing the selected feature, and return True."""
        return self._opened()

    def add_feature(self) -> None:
        """Start the entry of a new feature (F2)."""
        if not self.program_name or self.watch.production_records.lock_reason:
            self.desk.say(self.watch.production_records.lock_reason or NO_PROGRAM_MESSAGE)
            return
        self.desk.clear_prompt_line()
        self.draft = FeatureDraft(EMPTY_FEATURE, field_names=self.field_names)

    def edit_feature(self) -> None:
        """Start editing the selected feature.

        The readings of the feature remain stored.
        """
        row = self.selected_feature
        if row is None:
            self.desk.say(self.find_unmet_precondition())
            return
        self.desk.clear_prompt_line()
        self.draft = FeatureDraft(make_measured_feature(row), row.id, field_names=self.field_names)

    def save_feature(self) -> None:
        """Save the feature that is being edited (F6)."""
        draft = self.draft
        if draft is None:
            return
        try:
            if self.entry.text:
                self.accept_entry(self.entry.text)
            self.entry.text = ""
            check_feature(draft.feature)
        except (QualityError, InvalidEntryError) as error:
            self.desk.show_refusal(str(error))
            return
        row = make_feature_row(draft.feature, self.program_name, draft.feature_id)
        self._write(
            lambda c: measured_parts.save_feature(c, row),
            partial(self._kept, row.name),
            Message("feature {row} saved", row=row.name),
        )

    def _kept(self, name: str) -> None:
        self.draft = None
        self.desk.show_success(tr(Message("{name} SAVED", name=name)))

    def remove_feature(self) -> None:
        """Remove the selected feature from the measured features after the operator confirms (F4)."""
        row = self.selected_feature
        if row is None:
            self.desk.say(self.find_unmet_precondition())
            return
        asked = tr("STOP MEASURING {name}? READINGS STAY STORED. Y: STOP   N: CONTINUE")
        done = partial(self.desk.say, tr(Message("{name} REMOVED", name=row.name)))
        self.desk.ask_operator(
            tr(Message(asked, name=row.name)),
            lambda: self._write(
                lambda c: measured_parts.retire_feature(c, row.id),
                done,
                Message("{row} removed", row=row.name),
            ),
        )

    def _write(self, operation: Callable[..., object], done: Callable[[], None], change: str) -> None:
        text = Message("measured features of {program}: {change}", program=self.program_name, change=change)
        self.watch.production_records.write_change(
            ProtectedChange.FEATURES, operation, done, self.watch.report_refusal, text
        )

    def _turn_waits(self) -> None:
        if not self.program_name:
            self.desk.say(NO_PROGRAM_MESSAGE)
            return
        self.desk.clear_prompt_line()
        if not self.desk.is_refused(ProtectedChange.FEATURES):
            self.desk.try_save(self.plan.toggle_measurement_wait)

    def prompt_text(self) -> str:
        """Return the prompt that explains the current keys."""
        if self.draft is not None:
            return "FILL IN THE FIELDS. F6: SAVE   ESC: CANCEL"
        return self.find_unmet_precondition() or (
            "ENTER: CHANGE FEATURE   F2: NEW FEATURE   ESC: BACK TO LIST"
        )

    def handle_escape(self) -> bool:
        """Cancel the entry or discard the edited feature. Return False if neither was open."""
        if super().handle_escape():
            return True
        open_one, self.draft = self.draft is not None, None
        return open_one

    def on_close(self) -> None:
        """Discard the feature that is being edited when the section closes."""
        super().on_close()
        self.draft = None
