"""Setup of the office status page and of the announcements."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.stored_offsets import shapes_at_hand
from app.compose.workshop import thumbnails
from app.desk.kept_part import kept_part
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.status.standing_prompt import time_left
from app.extras.office.page_server import PageServer, listening_at
from app.production.parts_watch import PartsWatch
from app.shopfloor.floor_reading import FloorReader
from app.shopfloor.status_file import Status, status_of
from core.executor.snapshot import Snapshot
from core.extras.office.shop_network_tables import AnnounceTable, StatusPageTable
from core.message import Message
from core.ports import DriverError
from core.store.production.part_cycles import StopRow

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.extras.office.announcements import Told
    from app.extras.office.status_page import OtherDesk
    from app.programs.program_rows import DrawThumbnail
    from core.executor.job import Job
    from core.machine.machine_model import Machine


STOPS = 6  # number of latest stops


@dataclass(frozen=True, slots=True)
class OfficeLook:
    """Source of the status, readable from any thread.

    ``time_left`` returns seconds, inf while stopped.
    """

    machine: str
    reader: FloorReader
    snapshot: Callable[[], Snapshot]
    time_left: Callable[[Snapshot], float]
    stops: Callable[[], Sequence[StopRow]]
    utc: Callable[[], datetime]

    def status(self) -> Status:
        """Return the keys of status.json and of the page.

        Times are in seconds, and None means not known.
        """
        snapshot = self.snapshot()
        reading = self.reader.look(snapshot)
        told = {"updated": self.utc().isoformat(timespec="seconds"), **status_of(self.machine, reading)}
        if not reading.available:
            return {**told, **_NOTHING_KNOWN}
        left = self.time_left(snapshot)
        # in the order of recording, because the clock can have been set back
        newest = self.stops()[::-1][:STOPS]
        return {
            **told,
            "state": snapshot.state.value,
            "waiting_for": snapshot.waiting_for,
            "line": snapshot.line or None,
            "made": snapshot.made,
            "time_left": round(left, 1) if math.isfinite(left) and snapshot.counts else None,
            "cycle_elapsed": round(snapshot.cycle_elapsed, 1),
            "last_cycle": round(snapshot.last_cycle, 1) or None,
            "stop": _words(snapshot),
            "next_barred": snapshot.next_barred,
            "stops": [{"at": row.at, "reason": row.reason, "seconds": round(row.seconds)} for row in newest],
        }


_NOTHING_KNOWN: Status = {
    "state": "CONTROL SILENT",
    "waiting_for": "",
    "line": None,
    "made": None,
    "time_left": None,
    "cycle_elapsed": None,
    "last_cycle": None,
    "stop": "",
    "next_barred": "",
    "stops": [],
}


def _words(snapshot: Snapshot) -> str:
    """Return the reason why the machine is stopped, in the words of the screen."""
    if snapshot.alarms:
        return Message("{alarms}: {cause}", alarms=snapshot.alarms[0].text, cause=snapshot.alarms[0].cause)
    if snapshot.message:
        return snapshot.message
    told = snapshot.stop.text if snapshot.stop is not None else ""
    return "" if told == snapshot.state.value else told


PICTURE = 600, 400  # pixels, the size for a phone
MISSING = "{what} needs {package}, which is not installed; install turndesk[shop]"


def open_office(
    desk: Desk, machine: Machine, journal: Journal, tell: Callable[[str], None]
) -> Callable[[], None]:
    """Start the status page and the announcer, and return a function that stops them.

    The machine file enables them. A failure is reported, and the machine runs anyway.
    """
    look = _look(desk, machine)
    closing: list[Callable[[], None]] = []
    page, told = machine.hardware.table(StatusPageTable), machine.hardware.table(AnnounceTable)
    if page is not None and page.enabled:
        closing += _page(desk, machine, journal, page, look, tell)
    if told is not None and (told.mqtt or told.hook):
        closing += _announcer(told, look, tell)

    def close() -> None:
        for each in closing:
            each()

    return close


def _look(desk: Desk, machine: Machine) -> OfficeLook:
    reader = FloorReader(machine, time.monotonic)

    def left(snapshot: Snapshot) -> float:
        return time_left(snapshot, desk.session.now)

    def stops() -> Sequence[StopRow]:
        watch = desk.pages.find(PartsWatch)
        return watch.book.now.stops if watch is not None else ()

    return OfficeLook(machine.name, reader, desk.snapshot, left, stops, partial(datetime.now, UTC))


def _announcer(
    table: AnnounceTable, look: OfficeLook, tell: Callable[[str], None]
) -> list[Callable[[], None]]:
    from app.extras.office.announcements import Announcer
    from app.extras.office.web_hook import WebHook

    told: list[Told] = []
    if table.hook:
        told.append(WebHook(table.hook, table.again))
    if table.mqtt and find_spec("paho") is None:
        tell(MISSING.format(what="[announce] mqtt", package="paho-mqtt"))
    elif table.mqtt:
        from app.extras.office.mqtt_broker import MqttBroker

        told.append(MqttBroker(table))
    announcer = Announcer(look.status, told)
    announcer.start()
    return [announcer.close]


def _page(
    desk: Desk,
    machine: Machine,
    journal: Journal,
    table: StatusPageTable,
    look: OfficeLook,
    tell: Callable[[str], None],
) -> list[Callable[[], None]]:
    if find_spec("waitress") is None:
        tell(MISSING.format(what="[status_page]", package="waitress"))
        return []
    from app.extras.office.other_desks import OtherDesks, asked, asked_agent
    from app.extras.office.status_page import StatusPage

    try:
        listening = listening_at(table.bind, table.port)
    except DriverError as error:
        tell(str(error))
        return []

    def still() -> bool:
        return desk.snapshot().state not in UNDER_WAY

    def ask(address: str) -> OtherDesk:
        return asked_agent(address) if address in table.told_by_agents else asked(address)

    others = OtherDesks((*table.others, *table.told_by_agents), ask)
    kept = partial(kept_part, journal.read_setting)
    pictures = thumbnails(machine, shapes_at_hand, kept, size=PICTURE)
    part = PartPicture(lambda: desk.session.now.job, still, pictures)
    recordings = desk.control.recordings
    alarm = AlarmDrawing(recordings.folder if recordings is not None else None, still)

    def draw() -> None:
        part.look()
        alarm.look()

    page = StatusPage(machine.name, table.token, look.status, others.look, part.png, alarm.svg)
    server = PageServer(page, listening, draw)
    others.start()
    server.start()
    return [others.close, server.close]


@dataclass(slots=True)
class PartPicture:
    """PNG of the loaded program's part, drawn once per program and only while no program runs."""

    job: Callable[[], Job | None]
    still: Callable[[], bool]  # whether drawing delays nothing
    draw: DrawThumbnail
    _drawn: tuple[str, bytes] = ("", b"")

    def look(self) -> None:
        """Draw the part of a new program; called repeatedly by one thread."""
        job = self.job()
        if job is not None and job.digest != self._drawn[0] and self.still():
            self._drawn = job.digest, self._png(job)

    def png(self) -> bytes:
        """Return the PNG, or empty bytes if no part is drawn."""
        job, (digest, png) = self.job(), self._drawn
        return png if job is not None and job.digest == digest else b""

    def _png(self, job: Job) -> bytes:
        from app.extras.office.office_pictures import png_of

        found = self.draw(job, lambda _done: None)
        return png_of(found.pixels, found.width, found.height) if found is not None else b""


@dataclass(slots=True)
class AlarmDrawing:
    """Drawing of the latest alarm record of the scope. ``folder`` is None without records."""

    folder: Path | None
    still: Callable[[], bool]
    _drawn: tuple[str, bytes] = ("", b"")

    def look(self) -> None:
        """Draw a new record while no program runs."""
        from core.records.record_file import ENDING

        names = sorted(self.folder.glob(f"*-alarm*{ENDING}")) if self.folder is not None else []
        if names and names[-1].name != self._drawn[0] and self.still():
            self._drawn = names[-1].name, _drawing(names[-1])

    def svg(self) -> bytes:
        """Return the SVG, or empty bytes without a readable record."""
        return self._drawn[1]


def _drawing(record: Path) -> bytes:
    from app.extras.office.office_pictures import alarm_drawing
    from core.records.record import RecordError
    from core.records.record_file import open_record

    try:
        return alarm_drawing(open_record(record))
    except RecordError:
        return b""
