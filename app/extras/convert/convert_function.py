"""Special function CONVERT PROGRAM, which converts the convert the loaded program.

The function shows the findings and the converted program before it saves a new file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.page_description import ProgramConversion
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow, following
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.extras.convert.conversion_settings import ConversionSettings
from app.extras.convert.screen_conversion import (
    FILE_ENDINGS,
    ConversionRequest,
    ConversionResult,
    ProgramControl,
    convert_request,
    list_targets,
)
from app.programs.atomic_files import write_new_file
from app.special.special_functions import SpecialFunction, SpecialFunctionsModel
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.extras.convert.source_options import SourceControl, TargetControl
from core.interpreter.shared.job_setup import ControlLimits
from core.language.diagnostics import Diagnostic, Severity
from core.language.omniturn.other_controls import OTHER_CONTROL_CODE
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.message import Message

_MAX_PREVIEW_ROWS = 500
_SETTING_COUNT = 7
_FIRST_SOURCE_ROW, _LAST_SOURCE_ROW = 2, 4  # Settings that have no effect on an OmniTurn program.
_PENDING = "…"
_UNUSED = "NOT USED"
_NOT_SPECIFIED = "NOT SPECIFIED"
_UNITS: Mapping[bool | None, str] = {None: _NOT_SPECIFIED, False: "INCH", True: "MM"}
_X_VALUES: Mapping[bool | None, str] = {None: _NOT_SPECIFIED, True: "DIAMETER", False: "RADIUS"}
_POINTS: Mapping[float, str] = {0.0: _NOT_SPECIFIED, 1.0: "1000 UNITS", 0.001: "1 mm OR .1 in"}
_SCREEN_HINTS: Mapping[str, str] = {
    "unit": "CHANGE UNIT WITHOUT G20 OR G21 ABOVE.",
    "no-point": "CHANGE X1000 WITHOUT A POINT IS ABOVE.",
    "m-code": "PRESS ENTER ON M CODES LEFT OUT TO LEAVE IT OUT.",
}
"""Remedies on the screen by code of the finding, in place of options of the command."""
_TONES = {
    Severity.ERROR: StatusTone.ALARM,
    Severity.WARNING: StatusTone.WAIT,
    Severity.NOTE: StatusTone.READY,
}


class ConvertFunction(SpecialFunction):
    """Special function that converts the loaded program, shows the result and saves a new file.

    A worker converts the program when the function opens and when a setting changes.
    """

    name = "CONVERT PROGRAM"
    use = "convert the loaded program"

    def __init__(
        self, desk: Desk, machine: Machine, limits: ControlLimits, worker: LatestRequestWorker
    ) -> None:
        super().__init__(desk)
        self.machine, self.limits, self.worker = machine, limits, worker
        self.control: ProgramControl | None = None  # None: recognized from the program
        self.target: TargetControl | None = None  # None: the default for the control of the program
        self.settings = ConversionSettings()
        self.error_text = ""
        self._requested: ConversionRequest | None = None
        self._result: ConversionResult | None = None
        self._recognized: ProgramControl | None = None
        self._path: Path | None = None  # program to which the settings belong
        self._edited: tuple[ProgramSource, Path] | None = None  # program that the editor passed

    # --- display

    @property
    def program(self) -> tuple[ProgramSource, Path] | None:
        """Return the edited program, or else the loaded program, with its path.

        The result is None for a program in another language, such as SINUMERIK.
        """
        loaded = self.desk.program_loader.loaded_program
        found = self._edited or (loaded.source, loaded.path)
        source, path = found
        if source is None or path is None or source.dialect is not Dialect.OMNITURN:
            return None
        return source, path

    def convert_text(self, source: ProgramSource, path: Path) -> None:
        """Convert an edited program instead of the loaded program until the function closes."""
        self._edited = source, path

    @property
    def row_count(self) -> int:
        """Return the number of rows that can be selected."""
        return len(self._rows()) if self.program is not None else 0

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of settings, findings and converted lines."""
        self._convert_if_changed()
        if self.program is None:
            why = "CHOOSE THE PROGRAM OF THE OTHER CONTROL FIRST"
            return TableContent("CONVERT PROGRAM", ("", ""), (0.3, 0.7), (), notes=(why,))
        title = Message("CONVERT PROGRAM  ·  {name}", name=self.program[0].name)
        rows = self._rows()
        self.marked = max(0, min(self.marked, len(rows) - 1))
        return TableContent(
            title, ("", ""), (0.3, 0.7), tuple(rows), self.marked, notes=(self._summary(),),
            untranslated_columns=frozenset({0, 1}),
        )  # fmt: skip

    def _summary(self) -> str:
        if self.error_text:
            return self.error_text
        result = self._result
        if result is None:
            return "Converting the program …"
        count = len(result.conversion.errors)
        if count:
            return Message("NOT CONVERTED. CORRECT {count} ERROR(S) OR CHANGE A SETTING", count=count)
        proof = result.conversion.proof
        return Message(
            "{lines} LINES, {steps} STEPS PROVED EQUAL. F6 SAVES A NEW FILE",
            lines=len(result.conversion.lines),
            steps=proof.compared_step_count,
        )

    def _rows(self) -> list[TableRow]:
        rows = [TableRow((tr(name), tr(value))) for name, value in self._setting_values()]
        if self._result is None:
            return rows
        rows += [_make_finding_row(*each) for each in self._result.grouped_findings]
        if self._is_converted:
            rows += [
                TableRow((f"L{each.source_line_number}" if each.source_line_number else "", each.text))
                for each in self._result.conversion.lines[:_MAX_PREVIEW_ROWS]
            ]
        return rows

    @property
    def _shown_control(self) -> ProgramControl | None:
        """Return the selected or recognized control, or None while it is not known."""
        return self.control or self._recognized

    @property
    def _shown_target(self) -> TargetControl | None:
        """Return the target of the conversion, or None while it is not known."""
        if self._result is not None:
            return self._result.target
        control = self._shown_control
        targets = list_targets(control, self.machine.mdi_language) if control is not None else ()
        return self.target if self.target in targets else next(iter(targets), None)

    def _setting_values(self) -> list[tuple[str, str]]:
        control, target = self._shown_control, self._shown_target
        codes = ", ".join(f"M{code:02d}" for code in sorted(self.settings.skipped_m_codes)) or "NONE"
        values = [
            ("CONTROL", str(control).upper() if control is not None else _PENDING),
            ("TARGET", str(target).upper() if target is not None else _PENDING),
            ("UNIT WITHOUT G20 OR G21", _UNITS[self.settings.is_metric]),
            ("X1000 WITHOUT A POINT IS", _POINTS[self.settings.no_point]),
            ("X IS", _X_VALUES[self.settings.is_diameter]),
            ("TOOL POST", "FRONT" if self.settings.has_front_tool_post else "REAR"),
            ("M CODES LEFT OUT", codes),
        ]
        if control is Dialect.OMNITURN:
            for row in range(_FIRST_SOURCE_ROW, _LAST_SOURCE_ROW + 1):
                values[row] = (values[row][0], _UNUSED)
        return values

    # --- conversion

    def _convert_if_changed(self) -> None:
        if self.program is None:
            self._requested = self._result = None
            return
        source, path = self.program
        if path != self._path:
            # The settings are facts of one program, which the text of another program may not have.
            self._path, self.control, self.target, self.settings = path, None, None, ConversionSettings()
        wanted = ConversionRequest(source, self.control, self.target, self.settings)
        if wanted == self._requested:
            return
        if self._requested is None or self._requested.source is not source:
            self._recognized = None
        self._requested, self._result, self.error_text = wanted, None, ""
        self.worker.enqueue_work(
            partial(convert_request, wanted, self.machine, self.limits),
            partial(self._take, wanted),
            partial(self._fail, wanted),
        )

    def _take(self, request: ConversionRequest, result: ConversionResult) -> None:
        if request == self._requested:
            self._result = result
            self._recognized = result.control if request.control is None else self._recognized

    def _fail(self, request: ConversionRequest, why: str) -> None:
        if request == self._requested:
            self.error_text = why

    # --- keys

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function key that saves the converted program."""
        return {"F6": FunctionKey("SAVE", self.save_program, barred=not self._is_converted)}

    @property
    def _is_converted(self) -> bool:
        return self._result is not None and not self._result.conversion.errors

    def activate_selected_row(self) -> bool:
        """Change the selected setting, and return whether a setting was selected."""
        if self.program is None or self.marked >= _SETTING_COUNT:
            return False
        self.desk.clear_prompt_line()
        settings = self.settings
        if self.marked == 0:
            self.control = following((None, *SourceControl, Dialect.OMNITURN), self.control)
        elif self.marked == 1:
            self._select_next_target()
        elif self.marked <= _LAST_SOURCE_ROW and self._shown_control is Dialect.OMNITURN:
            self.desk.say("THIS SETTING HAS NO EFFECT ON AN OMNITURN PROGRAM")
        elif self.marked == 2:
            self.settings = replace(settings, is_metric=following(_UNITS, settings.is_metric))
        elif self.marked == 3:
            self.settings = replace(settings, no_point=following(_POINTS, settings.no_point))
        elif self.marked == 4:
            self.settings = replace(settings, is_diameter=following(_X_VALUES, settings.is_diameter))
        elif self.marked == 5:
            self.settings = replace(settings, has_front_tool_post=not settings.has_front_tool_post)
        else:
            self._skip_m_code()
        return True

    def _select_next_target(self) -> None:
        """Select the next target that is possible for the control of the program."""
        control = self._shown_control
        if control is not None:
            self.target = following(list_targets(control, self.machine.mdi_language), self._shown_target)

    def _skip_m_code(self) -> None:
        """Add the M code of the current error to the codes that are left out of the converted program.

        If the current error is not about an M code, clear these codes. An M code that is not a whole number
        cannot be left out.
        """
        error = next(iter(self._result.conversion.errors), None) if self._result is not None else None
        codes: frozenset[int] = frozenset()
        if error is not None and error.code == "m-code" and isinstance(error.hint, Message):
            number = str(error.hint.values["number"])
            codes = self.settings.skipped_m_codes | ({int(number)} if number.isdecimal() else frozenset())
        self.settings = replace(self.settings, skipped_m_codes=codes)

    def save_program(self) -> None:
        """Save the converted program as a new file. The file is not loaded."""
        result, program = self._result, self.program
        if result is None or result.conversion.errors or program is None:
            self.desk.say("THE PROGRAM IS NOT CONVERTED")
        elif not self.desk.is_refused(ProtectedChange.PROGRAMS):
            folder = self.desk.program_choice.program_folders.folders[0]
            target = folder / f"{program[1].stem}{FILE_ENDINGS[result.target]}"
            work = partial(_save, target, result.conversion.text)
            self.worker.enqueue_work(work, partial(self._saved, result.target), self.desk.show_refusal)

    def _saved(self, target: TargetControl, path: Path) -> None:
        if target == self.machine.mdi_language:
            text = "{name} SAVED, NOT LOADED. LOAD IT FROM THE LIST OF PROGRAMS"
        else:
            text = "{name} SAVED. F9 IN THE LIST OF PROGRAMS EXPORTS IT"
        self.desk.show_success(tr(Message(text, name=path.name)))

    def on_open(self) -> None:
        """Start with the first setting."""
        self.marked = 0

    def on_close(self) -> None:
        """Return to the loaded program."""
        self._edited = None

    def prompt_text(self) -> str:
        """Return the prompt that explains the current keys."""
        return "ENTER: CHANGE SETTING   F6: SAVE AS A NEW PROGRAM   ESC: BACK"


class RecognitionNotice:
    """Watcher that suggests the conversion once after a program of a different control is loaded."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._announced: ProgramSource | None = None

    def observe_frame(self, _snapshot: Snapshot) -> None:
        """Show the suggestion on the prompt line if the loaded program is for a different control."""
        loaded: LoadedProgram = self._desk.program_loader.loaded_program
        if loaded.source is None or loaded.source is self._announced or loaded.is_busy:
            return
        self._announced = loaded.source
        if any(each.code == OTHER_CONTROL_CODE for each in loaded.diagnostics):
            self._desk.say("PROGRAM OF ANOTHER CONTROL. F10, CONVERT PROGRAM CONVERTS IT")


def make_program_conversion(desk: Desk) -> ProgramConversion:
    """Return the conversion that the program list and the editor propose."""
    return ProgramConversion("SPECIAL FUNCTIONS", recognize_control_name, partial(_open_conversion, desk))


def recognize_control_name(lines: Sequence[str]) -> str:
    """Return the name of the other control of a program, or an empty string for an OmniTurn program."""
    from core.extras.convert.recognition import recognize_other_control

    control = recognize_other_control(lines)
    return str(control).upper() if control is not None else ""


def _open_conversion(desk: Desk, source: ProgramSource, path: Path) -> None:
    """Open CONVERT PROGRAM on the page of the special functions with an edited program."""
    model = desk.page_registry.find_model(SpecialFunctionsModel)
    functions = model.functions if model is not None else ()
    for index, function in enumerate(functions):
        if isinstance(function, ConvertFunction) and model is not None:
            model.open_function(index)
            function.convert_text(source, path)


def _save(target: Path, text: str) -> Path:
    """Write the new file on the worker. Raises FileOperationError if the name exists."""
    write_new_file(target, text.encode("ascii", "replace"))
    return target


def _make_finding_row(finding: Diagnostic, further_lines: str) -> TableRow:
    lines = f"{finding.line}, {further_lines}" if further_lines else str(finding.line or "")
    hint = tr(_SCREEN_HINTS.get(finding.code, finding.hint))
    return TableRow((lines, f"{tr(finding.message)} {hint}"), tone=_TONES[finding.severity])
