"""Keys of the office page and of events are exactly those of ``docs/json.md``."""

from __future__ import annotations

import json
from datetime import UTC, datetime

from app.compose.machine.machine_files import load_shipped_machine
from app.extras.office.announcements import Announcement
from app.extras.office.office_reference import EVENT_KEYS, STATUS_PAGE_KEYS
from app.extras.office.office_setup import StatusSource
from app.shopfloor.machine_reading import MachineReader
from app.shopfloor.status_file import StatusDocument
from core.executor.snapshot import Snapshot
from core.store.production.part_cycles import ProductionStopRow
from tests.cli.json_output import declared_alone
from tests.shopfloor.test_json_keys import shots


def office(snapshot: Snapshot) -> StatusDocument:
    reader = MachineReader(load_shipped_machine("gt75"), lambda: 0.0)
    stops = [ProductionStopRow("s", "", "pin.nc", "2026-11-23T08:00:00Z", 10.0, "FEED HOLD")]
    now = datetime(2026, 11, 23, 9, tzinfo=UTC)
    return StatusSource(
        "GT-75", reader, lambda: snapshot, lambda _: 42.0, lambda: stops, lambda: now
    ).read_status()


def test_office_page_and_events_have_the_declared_keys() -> None:
    told = [office(shot) for shot in shots()]
    declared_alone([json.loads(json.dumps(status)) for status in told], STATUS_PAGE_KEYS)
    declared_alone(
        [json.loads(Announcement("alarm", "X", status).make_json()) for status in told], EVENT_KEYS
    )


def test_key_meanings_are_sentences() -> None:
    assert [key for key in EVENT_KEYS if not key.meaning.endswith(".") or "|" in key.meaning] == []
