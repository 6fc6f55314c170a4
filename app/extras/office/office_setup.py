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

from app.compose.program_proving import create_thumbnail_drawer
from app.compose.stored_offsets import try_read_shapes
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.status.state_prompt import find_remaining_time_s
from app.desk.stored_part import load_stored_part
from app.extras.office.page_server import StatusPageServer, open_listening_socket
from app.production.parts_watch import ProductionMonitor
from app.shopfloor.machine_reading import MachineReader
from app.shopfloor.status_file import StatusDocument, make_status
from core.executor.snapshot import Snapshot
from core.extras.office.shop_network_tables import AnnounceTable, StatusPageTable
from core.message import Message
from core.ports import DriverError
from core.store.production.part_cycles import ProductionStopRow

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.extras.office.announcements import AnnouncementReceiver
    from app.extras.office.status_page import OtherMachine
    from app.programs.program_rows import DrawThumbnail
    from core.executor.job import Job
    from core.machine.machine_model import Machine


MAX_LISTED_STOPS = 6  # number of latest stops


@dataclass(frozen=True, slots=True)
class StatusSource:
    """Source of the machine status for the status page and the announcements.

    Any thread can read the status. ``calculate_remaining_time_s`` returns the remaining cycle time in
    seconds, or inf while the machine is stopped.
    """

    machine_name: str
    machine_reader: MachineReader
    read_snapshot: Callable[[], Snapshot]
    calculate_remaining_time_s: Callable[[Snapshot], float]
    read_stop_rows: Callable[[], Sequence[ProductionStopRow]]
    get_current_utc: Callable[[], datetime]

    def read_status(self) -> StatusDocument:
        """Return the values for status.json and the status page, by JSON key.

        Times are in seconds. None means that a value is not known.
        """
        snapshot = self.read_snapshot()
        reading = self.machine_reader.make_reading(snapshot)
        status = {
            "updated": self.get_current_utc().isoformat(timespec="seconds"),
            **make_status(self.machine_name, reading),
        }
        if not reading.is_available:
            return {**status, **_NOTHING_KNOWN}
        left = self.calculate_remaining_time_s(snapshot)
        # in the order of recording, because the clock can have been set back
        newest = self.read_stop_rows()[::-1][:MAX_LISTED_STOPS]
        return {
            **status,
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


_NOTHING_KNOWN: StatusDocument = {
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
    """Return the reason why the machine is stopped, with the same wording as on the screen."""
    if snapshot.alarms:
        return Message("{alarms}: {cause}", alarms=snapshot.alarms[0].text, cause=snapshot.alarms[0].cause)
    if snapshot.message:
        return snapshot.message
    stop_text = snapshot.stop.text if snapshot.stop is not None else ""
    return "" if stop_text == snapshot.state.value else stop_text


PICTURE_SIZE = 600, 400  # pixels, the size for a phone
MISSING_PACKAGE_MESSAGE = "{what} needs {package}, which is not installed; install turndesk[shop]"


def start_office_services(
    desk: Desk, machine: Machine, journal: Journal, report_error: Callable[[str], None]
) -> Callable[[], None]:
    """Start the status page and the announcer, and return a function that stops them.

    Each service starts only if the machine file enables it. If a service fails, the error is reported and
    the machine runs without that service.
    """
    look = _look(desk, machine)
    closing: list[Callable[[], None]] = []
    page, announce_table = (
        machine.hardware.find_driver_table(StatusPageTable),
        machine.hardware.find_driver_table(AnnounceTable),
    )
    if page is not None and page.enabled:
        closing += _page(desk, machine, journal, page, look, report_error)
    if announce_table is not None and (announce_table.mqtt or announce_table.hook):
        closing += _announcer(announce_table, look, report_error)

    def close() -> None:
        for each in closing:
            each()

    return close


def _look(desk: Desk, machine: Machine) -> StatusSource:
    reader = MachineReader(machine, time.monotonic)

    def calculate_remaining_time_s(snapshot: Snapshot) -> float:
        return find_remaining_time_s(snapshot, desk.program_loader.loaded_program)

    def read_stop_rows() -> Sequence[ProductionStopRow]:
        watch = desk.page_registry.find_model(ProductionMonitor)
        return watch.production_records.current_data.stops if watch is not None else ()

    return StatusSource(
        machine.name,
        reader,
        desk.read_snapshot,
        calculate_remaining_time_s,
        read_stop_rows,
        partial(datetime.now, UTC),
    )


def _announcer(
    table: AnnounceTable, look: StatusSource, tell: Callable[[str], None]
) -> list[Callable[[], None]]:
    from app.extras.office.announcements import Announcer
    from app.extras.office.web_hook import WebhookReceiver

    receivers: list[AnnouncementReceiver] = []
    if table.hook:
        receivers.append(WebhookReceiver(table.hook, table.again))
    if table.mqtt and find_spec("paho") is None:
        tell(MISSING_PACKAGE_MESSAGE.format(what="[announce] mqtt", package="paho-mqtt"))
    elif table.mqtt:
        from app.extras.office.mqtt_broker import MqttReceiver

        receivers.append(MqttReceiver(table))
    announcer = Announcer(look.read_status, receivers)
    announcer.start()
    return [announcer.close]


def _page(
    desk: Desk,
    machine: Machine,
    journal: Journal,
    table: StatusPageTable,
    look: StatusSource,
    tell: Callable[[str], None],
) -> list[Callable[[], None]]:
    if find_spec("waitress") is None:
        tell(MISSING_PACKAGE_MESSAGE.format(what="[status_page]", package="waitress"))
        return []
    from app.extras.office.other_machines import OtherMachines, read_agent_status, read_turndesk_status
    from app.extras.office.status_page import StatusPage

    try:
        listening = open_listening_socket(table.bind, table.port)
    except DriverError as error:
        tell(str(error))
        return []

    def is_machine_idle() -> bool:
        return desk.read_snapshot().state not in ACTIVE_STATES

    def read_other_status(address: str) -> OtherMachine:
        return (
            read_agent_status(address) if address in table.agent_addresses else read_turndesk_status(address)
        )

    others = OtherMachines((*table.other_page_addresses, *table.agent_addresses), read_other_status)
    kept = partial(load_stored_part, journal.read_setting)
    pictures = create_thumbnail_drawer(machine, try_read_shapes, kept, size_px=PICTURE_SIZE)
    part = PartPicture(lambda: desk.program_loader.loaded_program.job, is_machine_idle, pictures)
    recordings = desk.desk_control.recordings
    alarm = AlarmChart(recordings.folder if recordings is not None else None, is_machine_idle)

    def update_pictures() -> None:
        part.update()
        alarm.update()

    page = StatusPage(
        machine.name,
        table.token,
        look.read_status,
        others.read_machine_states,
        part.get_part_png,
        alarm.get_alarm_svg,
    )
    server = StatusPageServer(page, listening, update_pictures)
    others.start()
    server.start()
    return [others.close, server.close]


@dataclass(slots=True)
class PartPicture:
    """PNG image of the part that the loaded program makes.

    The part is drawn once per program, and only while no program runs.
    """

    get_job: Callable[[], Job | None]
    is_idle: Callable[[], bool]  # whether drawing delays nothing
    draw_thumbnail: DrawThumbnail
    _drawn: tuple[str, bytes] = ("", b"")

    def update(self) -> None:
        """Draw the part if the program has changed and no program runs.

        This method is called repeatedly by one thread.
        """
        job = self.get_job()
        if job is not None and job.digest != self._drawn[0] and self.is_idle():
            self._drawn = job.digest, self._png(job)

    def get_part_png(self) -> bytes:
        """Return the PNG image, or empty bytes if the part has not been drawn yet."""
        job, (digest, png) = self.get_job(), self._drawn
        return png if job is not None and job.digest == digest else b""

    def _png(self, job: Job) -> bytes:
        from app.extras.office.office_pictures import encode_png

        found = self.draw_thumbnail(job, lambda _done: None)
        return encode_png(found.pixels, found.width_px, found.height_px) if found is not None else b""


@dataclass(slots=True)
class AlarmChart:
    """SVG chart of the latest scope record that an alarm triggered.

    ``folder`` is None if no records are stored.
    """

    record_folder: Path | None
    is_idle: Callable[[], bool]
    _drawn: tuple[str, bytes] = ("", b"")

    def update(self) -> None:
        """Draw a new alarm record, but only while no program runs."""
        from core.records.record_file import RECORD_SUFFIX

        names = (
            sorted(self.record_folder.glob(f"*-alarm*{RECORD_SUFFIX}"))
            if self.record_folder is not None
            else []
        )
        if names and names[-1].name != self._drawn[0] and self.is_idle():
            self._drawn = names[-1].name, _drawing(names[-1])

    def get_alarm_svg(self) -> bytes:
        """Return the SVG chart, or empty bytes if there is no readable alarm record."""
        return self._drawn[1]


def _drawing(record: Path) -> bytes:
    from app.extras.office.office_pictures import make_alarm_svg
    from core.records.record import RecordError
    from core.records.record_file import open_record

    try:
        return make_alarm_svg(open_record(record))
    except RecordError:
        return b""
