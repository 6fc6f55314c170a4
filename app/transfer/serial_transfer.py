"""Special function for RS-232: line settings, sending and receiving programs.

A received program is stored but never started.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, fields, replace
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, InputField, TableContent, TableRow, following
from app.desk.persistence import Persistence
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.programs.atomic_files import FileOperationError
from app.special.special_functions import SpecialFunction
from app.transfer.line_transfer import (
    ReceivedProgram,
    SerialLineTransfer,
    SerialPorts,
    TransferProgress,
    find_unused_name,
    store_received_program,
)
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.machine.serial_and_backup_tables import SerialLineModel
from core.message import Message
from core.store.store_errors import StoreError

BAUD_RATES = (110, 300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200)
DATA_FORMATS = (
    ("7E1", 7, "E", 1),
    ("7E2", 7, "E", 2),
    ("7O1", 7, "O", 1),
    ("8N1", 8, "N", 1),
    ("8N2", 8, "N", 2),
    ("8E1", 8, "E", 1),
    ("8O1", 8, "O", 1),
)
FLOW_CONTROLS = ("xonxoff", "rtscts", "none")
LINE_ENDINGS = ("\r\n", "\n", "\r")
LEADER_LENGTHS = (0, 50, 200, 1000)
_EOL_NAMES = {"\r\n": "CR LF", "\n": "LF", "\r": "CR"}
_FLOW_NAMES = {"xonxoff": "XON/XOFF", "rtscts": "RTS/CTS", "none": "NONE"}

SelectNextValue = Callable[[SerialLineModel, Sequence[str]], SerialLineModel]
SettingRow = tuple[str, Callable[[SerialLineModel], str], SelectNextValue]


def _bits(model: SerialLineModel) -> str:
    return f"{model.bits}{model.parity}{model.stop}"


def _next_bits(model: SerialLineModel, _ports: Sequence[str]) -> SerialLineModel:
    name = following([each[0] for each in DATA_FORMATS], _bits(model))
    _, bits, parity, stop = next(each for each in DATA_FORMATS if each[0] == name)
    return replace(model, bits=bits, parity=parity, stop=stop)


def _yes(on: bool) -> str:
    return tr("YES") if on else tr("NO")


def _next_port(model: SerialLineModel, ports: Sequence[str]) -> SerialLineModel:
    return replace(model, port=following(ports, model.port)) if ports else model


SETTING_ROWS: tuple[SettingRow, ...] = (
    ("PORT", lambda m: m.port or "—", _next_port),
    ("SPEED", lambda m: f"{m.baud}", lambda m, _: replace(m, baud=following(BAUD_RATES, m.baud))),
    ("BITS, PARITY, STOP BITS", _bits, _next_bits),
    (
        "FLOW CONTROL",
        lambda m: tr(_FLOW_NAMES[m.flow]),
        lambda m, _: replace(m, flow=following(FLOW_CONTROLS, m.flow)),
    ),
    (
        "START/END CHARACTER",
        lambda m: m.wrap or tr("NONE"),
        lambda m, _: replace(m, wrap="" if m.wrap else "%"),
    ),
    ("LINE ENDING", lambda m: _EOL_NAMES[m.eol], lambda m, _: replace(m, eol=following(LINE_ENDINGS, m.eol))),
    ("DC CODES", lambda m: _yes(m.dc_codes), lambda m, _: replace(m, dc_codes=not m.dc_codes)),
    ("SEND ONLY AFTER DC1", lambda m: _yes(m.wait), lambda m, _: replace(m, wait=not m.wait)),
    (
        "LEADING NULS",
        lambda m: f"{m.leader}",
        lambda m, _: replace(m, leader=following(LEADER_LENGTHS, m.leader)),
    ),
)


def convert_settings_to_json(model: SerialLineModel) -> dict[str, object]:
    """Return the serial line settings as a dictionary for the settings store."""
    return asdict(model)


def read_settings(stored: object, default: SerialLineModel) -> SerialLineModel:
    """Return the stored serial line settings if they are valid, otherwise those of the machine file."""
    if not isinstance(stored, dict):
        return default
    good = {
        field.name: stored[field.name]
        for field in fields(SerialLineModel)
        if type(stored.get(field.name)) is type(getattr(default, field.name))
    }
    model = replace(default, **good)
    known = (
        model.flow in FLOW_CONTROLS
        and model.eol in LINE_ENDINGS
        and model.wrap in {"%", ""}
        and model.bits in {7, 8}
    )
    return model if known and model.parity in {"N", "E", "O"} and model.stop in {1, 2} else default


# --- tables ------------------------------------------------------------------------------------------------


TABLE_TITLE = "RS-232"
MAX_FINDINGS = 6  # maximum number of displayed findings


def make_settings_table(
    settings: SerialLineModel, selected_index: int, program_path: Path | None, last_result: str
) -> TableContent:
    """Return the table of the line settings and of the program to send."""
    rows = tuple(TableRow((tr(name), value(settings))) for name, value, _ in SETTING_ROWS)
    program = program_path.name if program_path is not None else "—"
    notes = (tr(Message("F4: send {program}", program=program)), last_result)
    return TableContent(
        TABLE_TITLE,
        ("SETTING", "VALUE"),
        (0.5, 0.5),
        rows,
        selected_index,
        notes=notes,
        untranslated_columns=frozenset({0, 1}),
    )


def make_progress_table(
    progress: TransferProgress, settings: SerialLineModel, sent_name: str
) -> TableContent:
    """Return the table with the progress of a transfer."""
    share = (
        f"{progress.transferred_byte_count / progress.total_byte_count:.0%}"
        if progress.total_byte_count
        else "—"
    )
    rows = (
        TableRow(
            (tr("SENDING") if sent_name else tr("RECEIVING"), sent_name or settings.port),
            True,
            StatusTone.RUN,
        ),
        TableRow(
            (
                tr("BYTES"),
                f"{progress.transferred_byte_count}"
                + (f" / {progress.total_byte_count}" if progress.total_byte_count else ""),
            )
        ),
        TableRow((tr("LINES"), f"{progress.transferred_line_count}")),
        TableRow((tr("DONE"), share)),
        TableRow(
            (tr("STATUS"), _describe_wait(progress.wait_reason)), bool(progress.wait_reason), StatusTone.WAIT
        ),
        *([TableRow((tr("INCOMING DATA"), progress.leading_text))] if progress.leading_text else ()),
    )
    words = f"{settings.port}  {settings.baud} {settings.bits}{settings.parity}{settings.stop}"
    return TableContent(
        TABLE_TITLE, ("", ""), (0.35, 0.65), rows, notes=(words,), untranslated_columns=frozenset({0, 1})
    )


def _describe_wait(what: str) -> str:
    """Return the display text for the reason why a transfer is waiting."""
    words = {
        "held": tr("STOPPED BY THE OTHER DEVICE (XOFF)"),
        "dc1": tr("WAITING FOR DC1 FROM THE OTHER DEVICE"),
        "sender": tr("WAITING FOR DATA FROM THE OTHER DEVICE"),
        "frame": tr("WAITING FOR THE START CHARACTER %"),
        "noise": tr("INCOMING DATA IS NOT TEXT: CHECK BAUD RATE, BITS AND PARITY"),
    }
    return words.get(what, "—")


def make_received_table(received: ReceivedProgram, name: str) -> TableContent:
    """Return the table about a received program: completeness, proof result and name."""
    code = tr("7 BITS, EVEN PARITY (DETECTED)") if received.is_seven_bit else tr("SAME AS SETTINGS")
    errors = len(received.finding_texts)
    some = tr("1 ERROR") if errors == 1 else tr(Message("{count} ERRORS", count=errors))
    result = some if errors else tr("NO ERRORS")
    lines = (
        tr("1 LINE") if received.line_count == 1 else tr(Message("{count} LINES", count=received.line_count))
    )
    rows = (
        TableRow((tr("WHOLE"), lines), True, StatusTone.RUN),
        TableRow((tr("PROVED"), result), True, StatusTone.ALARM if errors else StatusTone.RUN),
        TableRow((tr("NAME IN THE PROGRAM"), received.file_name or "—")),
        TableRow((tr("SHA-256"), received.sha256[:32] + " …")),
        TableRow((tr("CHARACTERS"), code)),
        TableRow((tr("CHARACTERS SKIPPED AT START"), f"{received.skipped_byte_count}")),
        *(TableRow(("", text)) for text in received.finding_texts[:MAX_FINDINGS]),
    )
    return TableContent(
        TABLE_TITLE,
        ("", ""),
        (0.25, 0.75),
        rows,
        entry_prompt="NAME FOR THE NEW PROGRAM?",
        text=name,
        notes=(
            *received.finding_texts[:1],
            ("The received program does not replace any program and is not started."),
        ),
        untranslated_columns=frozenset({0, 1}),
    )


SETTING_KEY = "rs232"
TRANSFER_IN_PROGRESS = "TRANSFER RUNNING. WAIT UNTIL IT IS DONE   F6: CANCEL"
SETTINGS_HINT = "ENTER: CHANGE VALUE   F4: SEND LOADED PROGRAM   F5: RECEIVE"
CONFIRM_DISCARD = "PRESS Y TO DISCARD THE RECEIVED PROGRAM, N TO KEEP IT"


class SerialTransferFunction(SpecialFunction):
    """Special function for transfers over RS-232.

    It has three states: settings, transfer, and naming of a received program.
    """

    name = "RS-232"
    use = "send and receive programs over the serial port"

    def __init__(
        self,
        desk: Desk,
        persistence: Persistence,
        serial_ports: SerialPorts,
        default: SerialLineModel,
        own_folder: Path,
    ) -> None:
        super().__init__(desk)
        self.persistence, self.serial_ports, self.own_folder = persistence, serial_ports, own_folder
        self.worker = LatestRequestWorker("editing-serial")
        self.line_settings = _stored_settings(persistence, default)
        self.port_names: Sequence[str] = ()
        self.running_transfer: SerialLineTransfer[int] | SerialLineTransfer[ReceivedProgram] | None = None
        self.sent_name = ""  # name of the program that is being sent
        self.received_program: ReceivedProgram | None = None
        self.name_field = InputField(words=True)
        self.last_result = ""  # result of the last transfer

    @property
    def row_count(self) -> int:
        """Return the number of settings, or 0 during a transfer or while a program is being named."""
        return 0 if self.running_transfer or self.received_program else len(SETTING_ROWS)

    def on_open(self) -> None:
        """List the serial ports when the function opens."""
        self.worker.enqueue_work(
            lambda: [device for device, _ in self.serial_ports.list_ports()],
            self._found,
            self.desk.show_refusal,
        )

    def _found(self, ports: list[str]) -> None:
        self.port_names = ports

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table for the settings, the active transfer or the received program."""
        self.worker.deliver_results()
        if self.received_program is not None:
            return make_received_table(self.received_program, self.name_field.text)
        if self.running_transfer is not None:
            return make_progress_table(self.running_transfer.progress, self.line_settings, self.sent_name)
        return make_settings_table(self.line_settings, self.marked, self._chosen(), self.last_result)

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys that are available now."""
        if self.received_program is not None:
            return {"F6": FunctionKey("DISCARD", self.confirm_program_discard)}
        if self.running_transfer is not None:
            return {"F6": FunctionKey("CANCEL", self.cancel_transfer)}
        return {
            "F4": FunctionKey(
                "SEND", self.send_program, barred=self._chosen() is None or not self.line_settings.port
            ),
            "F5": FunctionKey("RECEIVE", self.receive_program, barred=not self.line_settings.port),
            "F8": FunctionKey("PORTS", self.on_open),
        }

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the name of the received program."""
        return self.received_program is not None and self.name_field.accepts_key(key)

    def handle_key(self, key: str) -> bool:
        """Handle a key of the settings or of the name entry."""
        if self.received_program is not None:
            return self._named(key)
        return super().handle_key(key)

    def activate_selected_row(self) -> bool:
        """Change the selected setting if no transfer is active."""
        if self.row_count:
            self._step()
        return bool(self.row_count)

    def choose(self, row: int) -> None:
        """Select the touched setting if no transfer is active."""
        if self.row_count:
            super().choose(row)

    def prompt_text(self) -> str:
        """Return the prompt for the keys that are available now."""
        if self.received_program is not None:
            return "ENTER: SAVE AS A NEW PROGRAM (DOES NOT START)   F6: DISCARD"
        if self.running_transfer is not None:
            return "F6: CANCEL. TRANSFER CONTINUES WHILE OTHER PAGES ARE OPEN"
        return "ENTER: CHANGE VALUE   F4: SEND LOADED PROGRAM   F5: RECEIVE"

    def close(self) -> None:
        """Cancel the transfer, and stop the worker when TurnDesk closes."""
        self.cancel_transfer()
        self.worker.close()

    # --- transfers -----------------------------------------------------------------------------------

    def _chosen(self) -> Path | None:
        return self.desk.program_loader.loaded_program.path

    def send_program(self) -> None:
        """Handle F4: send the loaded program."""
        path = self._chosen()
        if path is None:
            self.desk.say("NO PROGRAM LOADED. F2: LOAD THE PROGRAM TO SEND")
        elif self._ready():
            self.sent_name = path.name
            carrying = self.serial_ports.make_send_transfer(self.line_settings, path)
            self.running_transfer = carrying
            self.worker.enqueue_work(carrying.run_transfer, self._sent, self._failed)

    def receive_program(self) -> None:
        """Handle F5: receive a program."""
        if self.desk.is_refused(ProtectedChange.PROGRAMS):
            return
        if self._ready():
            self.sent_name = ""
            carrying = self.serial_ports.make_receive_transfer(self.line_settings)
            self.running_transfer = carrying
            self.worker.enqueue_work(carrying.run_transfer, self._came, self._failed)

    def cancel_transfer(self) -> None:
        """Request cancellation of the running transfer.

        The worker reports the end of the transfer.
        """
        if self.running_transfer is not None:
            self.running_transfer.cancel()

    def _ready(self) -> bool:
        self.desk.clear_prompt_line()
        if self.running_transfer is not None or self.worker.is_busy:
            self.desk.say(TRANSFER_IN_PROGRESS)
        elif not self.line_settings.port:
            self.desk.say("NO PORT SELECTED. TAP THE FIRST LINE OR PRESS ENTER ON IT")
        else:
            return True
        return False

    def _sent(self, count: int) -> None:
        self.running_transfer = None
        self._done(tr(Message("{name} SENT: {count} BYTES", name=self.sent_name, count=count)))

    def _came(self, received: ReceivedProgram) -> None:
        self.running_transfer, self.received_program = None, received
        self.name_field.text = find_unused_name(self.own_folder, received.file_name)
        self._done(tr(Message("COMPLETE PROGRAM RECEIVED: {lines} LINES", lines=received.line_count)))

    def _failed(self, why: str) -> None:
        self.running_transfer = None
        self.last_result = tr(Message("NOTHING SAVED: {why}", why=why))
        self.desk.say(self.last_result)

    def _done(self, text: str) -> None:
        self.last_result = text
        self.desk.show_success(text)

    # --- name of the received program ----------------------------------------------------------------

    def _named(self, key: str) -> bool:
        if key == "Enter":
            self._store()
            return True
        if not self.name_field.handle_key(key):
            return False
        self.desk.clear_prompt_line()
        return True

    def _store(self) -> None:
        assert self.received_program is not None
        if self.desk.is_refused(ProtectedChange.PROGRAMS):
            return  # The received program remains until an authorized user has signed in.
        try:
            path = store_received_program(self.received_program, self.own_folder, self.name_field.text)
        except FileOperationError as error:
            self.desk.show_refusal(str(error))
            return
        self.received_program = None
        self.persistence.log_change(Message("program {path} received", path=path.name))
        self._done(tr(Message("SAVED AS A NEW PROGRAM: {name}. NOTHING WAS STARTED", name=path.name)))

    def confirm_program_discard(self) -> None:
        """Discard the received program after the operator confirms."""
        self.desk.ask_operator(CONFIRM_DISCARD, self._discarded)

    def _discarded(self) -> None:
        self.received_program = None
        self._done("RECEIVED PROGRAM DISCARDED")

    def _step(self) -> None:
        if self.desk.is_refused(ProtectedChange.TRANSFER):
            return
        if self.marked == 0 and not self.port_names:
            self.desk.say("NO SERIAL PORT FOUND. PLUG IN THE ADAPTER   F8: SEARCH AGAIN")
            return
        ports = (
            list(dict.fromkeys((*self.port_names, self.line_settings.port)))
            if self.line_settings.port
            else self.port_names
        )
        self.line_settings = replace(SETTING_ROWS[self.marked][2](self.line_settings, ports))
        self.desk.clear_prompt_line()
        try:
            self.persistence.save_setting(SETTING_KEY, convert_settings_to_json(self.line_settings))
            self.persistence.log_change(
                Message("serial port: {settings}", settings=convert_settings_to_json(self.line_settings))
            )
        except StoreError as error:
            self.desk.show_refusal(str(error))


def _stored_settings(persistence: Persistence, default: SerialLineModel) -> SerialLineModel:
    try:
        return read_settings(persistence.read_setting(SETTING_KEY), default)
    except StoreError:
        return default  # TurnDesk itself reports that nothing is stored.
