"""Keys of the office page and of events are exactly those of ``docs/json.md``."""

from __future__ import annotations

import json
from datetime import UTC, datetime

from app.compose.machine.machine_files import shipped_machine
from app.extras.office.announcements import Announcement
from app.extras.office.office_desk import OfficeLook
from app.extras.office.office_reference import EVENT, OFFICE
from app.shopfloor.floor_reading import FloorReader
from app.shopfloor.status_file import Status
from core.executor.snapshot import Snapshot
from core.store.production.part_cycles import StopRow
from tests.cli.json_output import declared_alone
from tests.shopfloor.test_json_keys import shots


def office(snapshot: Snapshot) -> Status:
    reader = FloorReader(shipped_machine("gt75"), lambda: 0.0)
    stops = [StopRow("s", "", "pin.nc", "2026-11-23T08:00:00Z", 10.0, "FEED HOLD")]
    now = datetime(2026, 11, 23, 9, tzinfo=UTC)
    return OfficeLook("GT-75", reader, lambda: snapshot, lambda _: 42.0, lambda: stops, lambda: now).status()


def test_the_office_page_and_events() -> None:
    told = [office(shot) for shot in shots()]
    declared_alone([json.loads(json.dumps(status)) for status in told], OFFICE)
    declared_alone([json.loads(Announcement("alarm", "X", status).json()) for status in told], EVENT)


def test_meanings_are_sentences() -> None:
    assert [key for key in EVENT if not key.meaning.endswith(".") or "|" in key.meaning] == []
