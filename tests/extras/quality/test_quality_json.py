"""What ``turndesk parts`` and ``turndesk shift`` print with --json has the declared keys."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

from app.extras.quality import quality_json_keys
from core.store.store import Store
from tests.cli.conftest import Turndesk
from tests.cli.json_output import declared_alone, whole


def test_parts_json_has_the_declared_keys(turndesk: Turndesk, filled: Path) -> None:
    declared_alone([whole(turndesk("parts", "--json"))], quality_json_keys.PARTS_OUTPUT.keys)


def test_shift_json_has_the_declared_keys(turndesk: Turndesk, filled: Path) -> None:
    with Store.open(filled) as store:
        store.events.log_event("alarm", "FOLLOWING ERROR").result(60)
    now = datetime.now()
    first, last = (f"{now + timedelta(days=days):%Y-%m-%d %H:%M}" for days in (-2, 2))
    found = whole(turndesk("shift", "--from", first, "--to", last, "--json"))
    declared_alone([found], quality_json_keys.SHIFT_OUTPUT.keys)
