"""Tables next to the curves of the scope: all signals, the trigger, and the stored recordings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from app.desk.arithmetic import InvalidEntryError, evaluate_expression, evaluate_line_number
from app.desk.pages.table_content import ROW_STEPS, FunctionKey, InputField, TableContent, TableRow, refused
from app.desk.status import formats
from app.desk.translation import tr
from app.scope.scope_files import ScopeFiles
from app.scope.scope_model import NO_SAMPLES_MESSAGE, ScopeModel, SidePanel
from app.scope.signals import ScopeSignal
from app.scope.time_window import TriggerEvent

_RELEASE, _SIGNAL, _LEVEL, _PLACE = range(4)  # rows of the trigger


@dataclass(slots=True)
class ScopeTables:
    """Tables of the scope page.

    Enter or a second touch executes the action of the selected row.
    """

    scope_model: ScopeModel
    selected_rows: dict[SidePanel, int] = field(default_factory=dict)
    input_field: InputField = field(default_factory=InputField)
    scope_files: ScopeFiles = field(init=False)

    def __post_init__(self) -> None:
        self.scope_files = ScopeFiles(self.scope_model)

    @property
    def selected_row(self) -> int:
        """Return the index of the selected row."""
        return max(0, min(self.selected_rows.get(self.scope_model.side_panel, 0), self.row_count - 1))

    @property
    def row_count(self) -> int:
        """Return the number of rows."""
        scope = self.scope_model
        return {
            SidePanel.READINGS: len(scope.shown),
            SidePanel.CURVES: len(scope.signals),
            SidePanel.TRIGGER: 4,
            SidePanel.FILES: len(scope.recording_store.recording_files),
        }[scope.side_panel]

    def open_table(self, side_panel: SidePanel) -> None:
        """Open a table, or return to the readings if this table is already open."""
        self.scope_model.desk.clear_prompt_line()
        self.input_field.text = ""
        self.scope_model.side_panel = (
            SidePanel.READINGS if self.scope_model.side_panel is side_panel else side_panel
        )
        if self.scope_model.side_panel is SidePanel.FILES:
            self.scope_files.reload_files()

    def make_table(self) -> TableContent:
        """Return the table that is shown now."""
        side = self.scope_model.side_panel
        if side is SidePanel.CURVES:
            return self._curves()
        return self._trigger() if side is SidePanel.TRIGGER else self._files()

    def _curves(self) -> TableContent:
        scope = self.scope_model
        metric = scope.metric
        rows = tuple(
            TableRow((each.title, each.quantity.unit(metric)), each.key in scope.selected_signal_keys)
            for each in scope.signals
        )
        notes = (tr("Velocities and ripple are calculated over the time shown next to their names."),)
        return TableContent(
            tr("CURVES"),
            ("", ""),
            (0.78, 0.22),
            rows,
            self.selected_row,
            notes=notes,
            untranslated_columns=frozenset({0}),
        )

    def _trigger(self) -> TableContent:
        scope = self.scope_model
        trigger, signal = scope.trigger, self._signal
        what, unit = "", ""
        if trigger.trigger_event.needs_level and signal is not None:
            quantity = signal.quantity
            unit = quantity.unit(scope.metric)
            what = formats.format_fixed(
                trigger.trigger_level * quantity.find_display_scale(scope.metric),
                quantity.places(scope.metric),
            )
        elif trigger.trigger_event is TriggerEvent.LINE:
            what = str(trigger.line_number)
        rows = (
            TableRow(("TRIGGER EVENT", tr(trigger.trigger_event.value))),
            TableRow(
                ("SIGNAL", signal.title if trigger.trigger_event.needs_level and signal is not None else "")
            ),
            TableRow(
                ("LINE" if trigger.trigger_event is TriggerEvent.LINE else "LEVEL", f"{what} {unit}".strip())
            ),
            TableRow(("TRIGGER POSITION IN WINDOW", formats.format_percent(trigger.fraction_before_event))),
        )
        asked = self.selected_row == _LEVEL and bool(what)
        return TableContent(
            tr("TRIGGER") + (f"  ·  {scope.trigger_state_text}" if scope.trigger_state_text else ""),
            ("", ""),
            (0.45, 0.55),
            rows,
            self.selected_row,
            entry_prompt=("LINE?" if trigger.trigger_event is TriggerEvent.LINE else "LEVEL?")
            if asked
            else "",
            text=self.input_field.text,
            notes=("The trigger freezes the curves only once.",),
            untranslated_columns=frozenset({1}),
        )

    def _files(self) -> TableContent:
        files = self.scope_model.recording_store.recording_files
        rows = tuple(
            TableRow((each.path.stem, each.modified_time_text, each.size_text), self._lit(each.path.name))
            for each in files
        )
        notes = () if files else (tr("No scope records yet. F2 saves the current view."),)
        heads = (tr("NAME"), tr("SAVED ON"), tr("SIZE"))
        return TableContent(
            tr("RECORDS"),
            heads,
            (0.55, 0.3, 0.15),
            rows,
            self.selected_row,
            notes=notes,
            untranslated_columns=frozenset({0}),
        )

    def _lit(self, name: str) -> bool:
        return name in {self.scope_model.recording_name, self.scope_model.overlay_name}

    @property
    def _signal(self) -> ScopeSignal | None:
        found = (each for each in self.scope_model.signals if each.key == self.scope_model.trigger.signal_key)
        return next(found, self.scope_model.selected_signal)

    # --- keys ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys while the records are listed."""
        if self.scope_model.side_panel is not SidePanel.FILES:
            return {}
        return {
            "F2": FunctionKey("SAVE", self.scope_files.save_visible_record),
            "F3": FunctionKey("OPEN", self._open),
            "F4": FunctionKey("OVERLAY", self._overlay),
            "F5": FunctionKey("CSV", self.scope_files.write_csv),
            "F8": FunctionKey("DELETE", self._delete),
        }

    def _open(self) -> None:
        if self.row_count:
            self.scope_files.open_file(self.scope_model.recording_store.recording_files[self.selected_row])

    def _overlay(self) -> None:
        if self.row_count:
            self.scope_files.overlay_file(self.scope_model.recording_store.recording_files[self.selected_row])

    def _delete(self) -> None:
        if self.row_count:
            self.scope_files.delete_file(self.scope_model.recording_store.recording_files[self.selected_row])

    @property
    def needs_value(self) -> bool:
        """Return whether the selected action requires the operator to enter a value."""
        return self.scope_model.side_panel is SidePanel.TRIGGER and bool(self._trigger().entry_prompt)

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered as part of a value."""
        return self.needs_value and self.input_field.accepts_key(key)

    def handle_key(self, key: str) -> bool:
        """Handle a key of the table.

        Arrow keys select a row, Enter executes the action of the row, and digits edit the entry.
        """
        if self.needs_value and self.input_field.handle_key(key):
            self.scope_model.desk.clear_prompt_line()
            return True
        if key in ROW_STEPS and self.row_count:
            self.select_row(max(0, min(self.row_count - 1, self.selected_row + ROW_STEPS[key])))
            return True
        if key == "Enter" and self.row_count:
            self.execute_row()
            return True
        return False

    def select_row(self, row: int) -> None:
        """Select a row, and discard a value that was typed for another row."""
        self.input_field.text = ""
        self._mark(row)

    def _mark(self, row: int) -> None:
        self.selected_rows[self.scope_model.side_panel] = row
        if self.scope_model.side_panel is SidePanel.READINGS:
            self.scope_model.mark(row)

    def handle_row_touch(self, row: int) -> None:
        """Handle a touch of a row.

        A touch on a curve immediately shows or hides it. For other rows, a second touch executes the
        action.
        """
        if row >= self.row_count:
            return
        again = row == self.selected_row
        self._mark(row)
        if self.scope_model.side_panel is SidePanel.CURVES or again:
            self.execute_row()

    def execute_row(self) -> None:
        """Execute the action of the selected row."""
        scope = self.scope_model
        scope.desk.clear_prompt_line()
        if scope.side_panel is SidePanel.CURVES:
            scope.toggle_curve(scope.signals[self.selected_row])
        elif scope.side_panel is SidePanel.FILES:
            self._open()
        elif scope.side_panel is SidePanel.TRIGGER:
            self._act_on_trigger()

    def _act_on_trigger(self) -> None:
        trigger, row = self.scope_model.trigger, self.selected_row
        if row == _RELEASE:
            order = list(TriggerEvent)
            following = order[(order.index(trigger.trigger_event) + 1) % len(order)]
            signal = self._signal
            name = signal.key if signal is not None else ""
            self.scope_model.set_trigger(replace(trigger, trigger_event=following, signal_key=name))
        elif row == _SIGNAL and trigger.trigger_event.needs_level and self.scope_model.shown:
            names = [each.key for each in self.scope_model.shown]
            at = names.index(trigger.signal_key) if trigger.signal_key in names else -1
            self.scope_model.set_trigger(replace(trigger, signal_key=names[(at + 1) % len(names)]))
        elif row == _LEVEL and self.needs_value and self.input_field.text:
            self._handle_enter()
        elif row == _PLACE:
            self.scope_model.set_trigger(trigger.with_next_position())

    def _handle_enter(self) -> None:
        """Accept the typed value, or report why the value is invalid."""
        scope, trigger = self.scope_model, self.scope_model.trigger
        if trigger.trigger_event is TriggerEvent.LINE:
            line = evaluate_line_number(self.input_field.text)
            if line is None:
                self.input_field.text = refused(self.input_field.text)
                scope.desk.show_refusal(
                    tr("enter the number of the program line as a whole number, 1 or more")
                )
                return
            scope.set_trigger(replace(trigger, line_number=line))
            self.input_field.text = ""
            return
        signal = self._signal
        scale = signal.quantity.find_display_scale(scope.metric) if signal is not None else 1.0
        try:
            scope.set_trigger(
                replace(trigger, trigger_level=evaluate_expression(self.input_field.text) / scale)
            )
        except InvalidEntryError as error:
            self.input_field.text = refused(self.input_field.text)
            scope.desk.show_refusal(str(error))
            return
        self.input_field.text = ""

    def handle_escape(self) -> bool:
        """Go back one step.

        Return False if neither a table nor the cursors are shown, so that there is no step to go back.
        """
        scope = self.scope_model
        if scope.desk.prompt_notice:
            scope.desk.clear_prompt_line()
        elif self.input_field.text:
            self.input_field.text = ""
        elif scope.side_panel is not SidePanel.READINGS:
            scope.side_panel = SidePanel.READINGS
        elif scope.cursors.shown:
            scope.cursors.active_index = -1
        else:
            return False
        return True

    def prompt_text(self) -> str:
        """Return the prompt for the keys that are available now."""
        if self.scope_model.side_panel is SidePanel.READINGS:
            if self.scope_model.cursors.shown:
                return tr("ARROWS: MOVE CURSOR   TAB: OTHER CURSOR   CTRL+ARROWS: PAN")
            if not self.scope_model.has_samples:
                return NO_SAMPLES_MESSAGE
            return tr("UP/DOWN: SELECT CURVE   Z: ZOOM   CTRL+ARROWS: PAN, STRETCH")
        if self.scope_model.side_panel is SidePanel.CURVES:
            return tr("ENTER: SHOW OR HIDE CURVE   ESC: BACK TO CURVES")
        if self.scope_model.side_panel is SidePanel.TRIGGER:
            return tr("ENTER: NEXT CHOICE   DIGITS: TYPE LEVEL   ESC: BACK")
        return tr("F2: SAVE THE VIEW   ENTER: OPEN RECORD   ESC: BACK TO CURVES")
