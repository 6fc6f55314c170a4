"""Keys of status.json, of the office page and of events are exactly those of ``docs/json.md``."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from app.compose.machine_files import shipped_machine
from app.shopfloor.announcements import Announcement
from app.shopfloor.floor_reading import FloorReader
from app.shopfloor.json_keys import EVENT, FILE, OFFICE
from app.shopfloor.office_status import OfficeLook
from app.shopfloor.status_file import Status, StatusFile, status_of
from core.alarms import CATALOGUE
from core.executor.interrupted_job import InterruptedJob
from core.executor.snapshot import Alarm, Snapshot, State
from core.store.part_cycles import StopRow
from tests.cli.json_output import declared_alone

INTERRUPTED = InterruptedJob(
    "pin.nc", "job", "text", 4, 7, 7, 1, 12, ("X", "Z"), (0.0, 0.0), "E-STOP", "2026-11-23T08:00:00Z"
)


def office(snapshot: Snapshot) -> Status:
    reader = FloorReader(shipped_machine("gt75"), frozenset({"Xservo", "system"}), lambda: 0.0)
    stops = [StopRow("s", "", "pin.nc", "2026-11-23T08:00:00Z", 10.0, "FEED HOLD")]
    now = datetime(2026, 11, 23, 9, tzinfo=UTC)
    return OfficeLook("GT-75", reader, lambda: snapshot, lambda _: 42.0, lambda: stops, lambda: now).status()


def shots() -> list[Snapshot]:
    found = CATALOGUE["following"]
    alarm = Alarm(found.number, "following", found.text, "X", found.remedy, 4)
    running = Snapshot(state=State.RUN, program="/p/pin.nc", counts=True, made=3, line=9, spindle_load=41.0)
    return [running, replace(running, state=State.FAULT, alarms=(alarm,), interrupted=INTERRUPTED)]


def test_the_office_page_and_events() -> None:
    told = [office(shot) for shot in shots()]
    declared_alone([json.loads(json.dumps(status)) for status in told], OFFICE)
    declared_alone([json.loads(Announcement("alarm", "X", status).json()) for status in told], EVENT)


def test_status_json(tmp_path: Path) -> None:
    reader = FloorReader(shipped_machine("gt75"), frozenset({"Xservo", "system"}), lambda: 0.0)
    values = []
    for number, shot in enumerate(shots()):
        path = tmp_path / f"{number}.json"
        StatusFile(path, lambda: "2026-11-23T08:00:00Z").show(status_of("GT-75", reader.look(shot)))
        values.append(json.loads(path.read_text("utf-8")))
    declared_alone(values, FILE)
