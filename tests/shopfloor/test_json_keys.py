"""Keys of status.json are exactly those of ``docs/json.md``."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from app.compose.machine.machine_files import load_shipped_machine
from app.shopfloor.json_keys import FILE_KEYS
from app.shopfloor.machine_reading import MachineReader
from app.shopfloor.status_file import StatusFileWriter, make_status
from core.alarms import CATALOG
from core.executor.snapshot import Alarm, InterruptedJob, MachineState, Snapshot
from tests.cli.json_output import declared_alone

INTERRUPTED = InterruptedJob(
    "pin.nc", "job", "text", 4, 7, 7, 1, 12, ("X", "Z"), (0.0, 0.0), "E-STOP", "2026-11-23T08:00:00Z"
)


def shots() -> list[Snapshot]:
    found = CATALOG["following"]
    alarm = Alarm(found.number, "following", found.text, "X", found.remedy, 4)
    running = Snapshot(
        state=MachineState.RUN, program="/p/pin.nc", counts=True, made=3, line=9, spindle_load=41.0
    )
    return [running, replace(running, state=MachineState.FAULT, alarms=(alarm,), interrupted=INTERRUPTED)]


def test_status_json_keys_are_documented(tmp_path: Path) -> None:
    reader = MachineReader(load_shipped_machine("gt75"), lambda: 0.0)
    values = []
    for number, shot in enumerate(shots()):
        path = tmp_path / f"{number}.json"
        StatusFileWriter(path, lambda: "2026-11-23T08:00:00Z").write_status(
            make_status("GT-75", reader.make_reading(shot))
        )
        values.append(json.loads(path.read_text("utf-8")))
    declared_alone(values, FILE_KEYS)
