"""Special function RS-232: settings, sending and receiving.

A received program is stored but never started.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, fields, replace
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import Entry, Key, Row, Sheet, following
from app.desk.persistence import Persistence
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.programs.whole_file import FileError
from app.special.special_functions import SpecialFunction
from app.transfer.line_transfer import Received, SerialPorts, Transfer, TransferProgress, free_name, store_new
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.machine.desk_tables import DncModel
from core.message import Message
from core.store.store_errors import StoreError

BAUDS = (110, 300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200)
BITS = (("7E1", 7, "E", 1), ("7E2", 7, "E", 2), ("7O1", 7, "O", 1), ("8N1", 8, "N", 1), ("8N2", 8, "N", 2),
        ("8E1", 8, "E", 1), ("8O1", 8, "O", 1))  # fmt: skip
FLOWS = ("xonxoff", "rtscts", "none")
EOLS = ("\r\n", "\n", "\r")
LEADERS = (0, 50, 200, 1000)
_EOL_NAMES = {"\r\n": "CR LF", "\n": "LF", "\r": "CR"}
_FLOW_NAMES = {"xonxoff": "XON/XOFF", "rtscts": "RTS/CTS", "none": "NONE"}

Step = Callable[[DncModel, Sequence[str]], DncModel]
SettingRow = tuple[str, Callable[[DncModel], str], Step]


def _bits(model: DncModel) -> str:
    return f"{model.bits}{model.parity}{model.stop}"


def _next_bits(model: DncModel, _ports: Sequence[str]) -> DncModel:
    name = following([each[0] for each in BITS], _bits(model))
    _, bits, parity, stop = next(each for each in BITS if each[0] == name)
    return replace(model, bits=bits, parity=parity, stop=stop)


def _yes(on: bool) -> str:
    return tr("YES") if on else tr("NO")


def _next_port(model: DncModel, ports: Sequence[str]) -> DncModel:
    return replace(model, port=following(ports, model.port)) if ports else model


ROWS: tuple[SettingRow, ...] = (
    ("PORT", lambda m: m.port or "—", _next_port),
    ("SPEED", lambda m: f"{m.baud}", lambda m, _: replace(m, baud=following(BAUDS, m.baud))),
    ("BITS, PARITY, STOP BITS", _bits, _next_bits),
    (
        "FLOW CONTROL",
        lambda m: tr(_FLOW_NAMES[m.flow]),
        lambda m, _: replace(m, flow=following(FLOWS, m.flow)),
    ),
    (
        "START/END CHARACTER",
        lambda m: m.wrap or tr("NONE"),
        lambda m, _: replace(m, wrap="" if m.wrap else "%"),
    ),
    ("LINE ENDING", lambda m: _EOL_NAMES[m.eol], lambda m, _: replace(m, eol=following(EOLS, m.eol))),
    ("DC CODES", lambda m: _yes(m.dc_codes), lambda m, _: replace(m, dc_codes=not m.dc_codes)),
    ("SEND ONLY AFTER DC1", lambda m: _yes(m.wait), lambda m, _: replace(m, wait=not m.wait)),
    (
        "LEADING NULS",
        lambda m: f"{m.leader}",
        lambda m, _: replace(m, leader=following(LEADERS, m.leader)),
    ),
)


def stored_form(model: DncModel) -> dict[str, object]:
    """Return the settings in the form for the store."""
    return asdict(model)


def settings_of(kept: object, default: DncModel) -> DncModel:
    """Return the valid stored settings, or the settings of the machine file."""
    if not isinstance(kept, dict):
        return default
    good = {
        field.name: kept[field.name]
        for field in fields(DncModel)
        if type(kept.get(field.name)) is type(getattr(default, field.name))
    }
    model = replace(default, **good)
    known = model.flow in FLOWS and model.eol in EOLS and model.wrap in {"%", ""} and model.bits in {7, 8}
    return model if known and model.parity in {"N", "E", "O"} and model.stop in {1, 2} else default


# --- tables ------------------------------------------------------------------------------------------------


TITLE = "RS-232"
SHOWN = 6  # maximum number of displayed findings


def settings_sheet(settings: DncModel, marked: int, chosen: Path | None, last: str) -> Sheet:
    """Return the table of the line settings and of the program to send."""
    rows = tuple(Row((tr(name), value(settings))) for name, value, _ in ROWS)
    program = chosen.name if chosen is not None else "—"
    notes = (tr(Message("F4: send {program}", program=program)), last)
    return Sheet(TITLE, ("SETTING", "VALUE"), (0.5, 0.5), rows, marked, notes=notes, raw=frozenset({0, 1}))


def progress_sheet(reach: TransferProgress, settings: DncModel, sends: str) -> Sheet:
    """Return the table with the progress of a transfer."""
    share = f"{reach.done / reach.total:.0%}" if reach.total else "—"
    rows = (
        Row((tr("SENDING") if sends else tr("RECEIVING"), sends or settings.port), True, Tone.RUN),
        Row((tr("BYTES"), f"{reach.done}" + (f" / {reach.total}" if reach.total else ""))),
        Row((tr("LINES"), f"{reach.lines}")),
        Row((tr("DONE"), share)),
        Row((tr("STATUS"), _waits(reach.what)), bool(reach.what), Tone.WAIT),
        *([Row((tr("INCOMING DATA"), reach.heard))] if reach.heard else ()),
    )
    words = f"{settings.port}  {settings.baud} {settings.bits}{settings.parity}{settings.stop}"
    return Sheet(TITLE, ("", ""), (0.35, 0.65), rows, notes=(words,), raw=frozenset({0, 1}))


def _waits(what: str) -> str:
    """Return the text for a reason for waiting."""
    words = {
        "held": tr("STOPPED BY THE OTHER DEVICE (XOFF)"),
        "dc1": tr("WAITING FOR DC1 FROM THE OTHER DEVICE"),
        "sender": tr("WAITING FOR DATA FROM THE OTHER DEVICE"),
        "frame": tr("WAITING FOR THE START CHARACTER %"),
        "noise": tr("INCOMING DATA IS NOT TEXT: CHECK BAUD RATE, BITS AND PARITY"),
    }
    return words.get(what, "—")


def received_sheet(received: Received, name: str) -> Sheet:
    """Return the table of a received program: completeness, proof and name."""
    code = tr("7 BITS, EVEN PARITY (DETECTED)") if received.seven else tr("SAME AS SETTINGS")
    errors = len(received.findings)
    some = tr("1 ERROR") if errors == 1 else tr(Message("{count} ERRORS", count=errors))
    result = some if errors else tr("NO ERRORS")
    lines = tr("1 LINE") if received.lines == 1 else tr(Message("{count} LINES", count=received.lines))
    rows = (
        Row((tr("WHOLE"), lines), True, Tone.RUN),
        Row((tr("PROVED"), result), True, Tone.ALARM if errors else Tone.RUN),
        Row((tr("NAME IN THE PROGRAM"), received.name or "—")),
        Row((tr("SHA-256"), received.digest[:32] + " …")),
        Row((tr("CHARACTERS"), code)),
        Row((tr("CHARACTERS SKIPPED AT START"), f"{received.skipped}")),
        *(Row(("", text)) for text in received.findings[:SHOWN]),
    )
    return Sheet(
        TITLE,
        ("", ""),
        (0.25, 0.75),
        rows,
        question="NAME FOR THE NEW PROGRAM?",
        text=name,
        notes=(
            *received.findings[:1],
            ("The received program does not replace any program and is not started."),
        ),
        raw=frozenset({0, 1}),
    )


SETTING = "rs232"
BUSY = "TRANSFER RUNNING. WAIT UNTIL IT IS DONE   F6: CANCEL"
SETS = "ENTER: CHANGE VALUE   F4: SEND LOADED PROGRAM   F5: RECEIVE"
THROW_AWAY = "PRESS Y TO DISCARD THE RECEIVED PROGRAM, N TO KEEP IT"


class SerialTransfer(SpecialFunction):
    """Special function RS-232 with three states: settings, transfer, and naming of a received program."""

    name = "RS-232"
    use = "send and receive programs over the serial port"

    def __init__(
        self, desk: Desk, persistence: Persistence, lines: SerialPorts, default: DncModel, own: Path
    ) -> None:
        super().__init__(desk)
        self.persistence, self.lines, self.own = persistence, lines, own
        self.worker = Latest("editing-serial")
        self.settings = _stored_settings(persistence, default)
        self.ports: Sequence[str] = ()
        self.under_way: Transfer[int] | Transfer[Received] | None = None
        self.sends = ""  # name of the program that is being sent
        self.received: Received | None = None
        self.entry = Entry(words=True)
        self.last = ""  # result of the last transfer

    @property
    def count(self) -> int:
        """Number of settings, or 0 during a transfer."""
        return 0 if self.under_way or self.received else len(ROWS)

    def opened(self) -> None:
        """List the serial ports when the function opens."""
        self.worker.queue(lambda: [device for device, _ in self.lines.ports()], self._found, self.desk.refuse)

    def _found(self, ports: list[str]) -> None:
        self.ports = ports

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of the present state."""
        self.worker.poll()
        if self.received is not None:
            return received_sheet(self.received, self.entry.text)
        if self.under_way is not None:
            return progress_sheet(self.under_way.reach, self.settings, self.sends)
        return settings_sheet(self.settings, self.marked, self._chosen(), self.last)

    def keys(self) -> Mapping[str, Key]:
        """Return the present function keys."""
        if self.received is not None:
            return {"F6": Key("DISCARD", self.discard)}
        if self.under_way is not None:
            return {"F6": Key("CANCEL", self.cancel)}
        return {
            "F4": Key("SEND", self.send, barred=self._chosen() is None or not self.settings.port),
            "F5": Key("RECEIVE", self.receive, barred=not self.settings.port),
            "F8": Key("PORTS", self.opened),
        }

    def takes(self, key: str) -> bool:
        """Return whether a character is part of the name of the received program."""
        return self.received is not None and self.entry.takes(key)

    def typed(self, key: str) -> bool:
        """Handle a key of the settings or of the name entry."""
        if self.received is not None:
            return self._named(key)
        return super().typed(key)

    def act(self) -> bool:
        """Change the selected setting if no transfer is active."""
        if self.count:
            self._step()
        return bool(self.count)

    def choose(self, row: int) -> None:
        """Select the touched setting if no transfer is active."""
        if self.count:
            super().choose(row)

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.received is not None:
            return "ENTER: SAVE AS A NEW PROGRAM (DOES NOT START)   F6: DISCARD"
        if self.under_way is not None:
            return "F6: CANCEL. TRANSFER CONTINUES WHILE OTHER PAGES ARE OPEN"
        return "ENTER: CHANGE VALUE   F4: SEND LOADED PROGRAM   F5: RECEIVE"

    def close(self) -> None:
        """Cancel the transfer and stop the worker when TurnDesk closes."""
        self.cancel()
        self.worker.close()

    # --- transfers -----------------------------------------------------------------------------------

    def _chosen(self) -> Path | None:
        return self.desk.session.now.path

    def send(self) -> None:
        """Send the loaded program (F4)."""
        path = self._chosen()
        if path is None:
            self.desk.say("NO PROGRAM LOADED. F2: LOAD THE PROGRAM TO SEND")
        elif self._ready():
            self.sends = path.name
            carrying = self.lines.send(self.settings, path)
            self.under_way = carrying
            self.worker.queue(carrying.run, self._sent, self._failed)

    def receive(self) -> None:
        """Receive a program (F5)."""
        if self.desk.refused(Act.PROGRAMS):
            return
        if self._ready():
            self.sends = ""
            carrying = self.lines.receive(self.settings)
            self.under_way = carrying
            self.worker.queue(carrying.run, self._came, self._failed)

    def cancel(self) -> None:
        """Cancel the transfer. The worker reports the end."""
        if self.under_way is not None:
            self.under_way.cancel()

    def _ready(self) -> bool:
        self.desk.clear()
        if self.under_way is not None or self.worker.busy:
            self.desk.say(BUSY)
        elif not self.settings.port:
            self.desk.say("NO PORT SELECTED. TAP THE FIRST LINE OR PRESS ENTER ON IT")
        else:
            return True
        return False

    def _sent(self, count: int) -> None:
        self.under_way = None
        self._done(tr(Message("{name} SENT: {count} BYTES", name=self.sends, count=count)))

    def _came(self, received: Received) -> None:
        self.under_way, self.received = None, received
        self.entry.text = free_name(self.own, received.name)
        self._done(tr(Message("COMPLETE PROGRAM RECEIVED: {lines} LINES", lines=received.lines)))

    def _failed(self, why: str) -> None:
        self.under_way = None
        self.last = tr(Message("NOTHING SAVED: {why}", why=why))
        self.desk.say(self.last)

    def _done(self, text: str) -> None:
        self.last = text
        self.desk.done(text)

    # --- name of the received program ----------------------------------------------------------------

    def _named(self, key: str) -> bool:
        if key == "Enter":
            self._store()
            return True
        if not self.entry.type(key):
            return False
        self.desk.clear()
        return True

    def _store(self) -> None:
        assert self.received is not None
        if self.desk.refused(Act.PROGRAMS):
            return  # The received program remains until an authorized user has signed in.
        try:
            path = store_new(self.received, self.own, self.entry.text)
        except FileError as error:
            self.desk.refuse(str(error))
            return
        self.received = None
        self.persistence.note_change(Message("program {path} received", path=path.name))
        self._done(tr(Message("SAVED AS A NEW PROGRAM: {name}. NOTHING WAS STARTED", name=path.name)))

    def discard(self) -> None:
        """Discard the received program after confirmation."""
        self.desk.ask(THROW_AWAY, self._discarded)

    def _discarded(self) -> None:
        self.received = None
        self._done("RECEIVED PROGRAM DISCARDED")

    def _step(self) -> None:
        if self.desk.refused(Act.TRANSFER):
            return
        if self.marked == 0 and not self.ports:
            self.desk.say("NO SERIAL PORT FOUND. PLUG IN THE ADAPTER   F8: SEARCH AGAIN")
            return
        ports = list(dict.fromkeys((*self.ports, self.settings.port))) if self.settings.port else self.ports
        self.settings = replace(ROWS[self.marked][2](self.settings, ports))
        self.desk.clear()
        try:
            self.persistence.save_setting(SETTING, stored_form(self.settings))
            self.persistence.note_change(
                Message("serial port: {settings}", settings=stored_form(self.settings))
            )
        except StoreError as error:
            self.desk.refuse(str(error))


def _stored_settings(persistence: Persistence, default: DncModel) -> DncModel:
    try:
        return settings_of(persistence.read_setting(SETTING), default)
    except StoreError:
        return default  # TurnDesk itself reports that nothing is stored.
