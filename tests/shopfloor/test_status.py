"""The status file: what it says, when it is written, and what happens where it cannot be."""

from __future__ import annotations

import json
import threading
from dataclasses import replace
from pathlib import Path

import pytest

from app.shopfloor.machine_reading import MachineReading
from app.shopfloor.status_file import StatusDocument, StatusFileUpdater, StatusFileWriter, make_status
from core.alarms import CATALOG
from core.executor.raised_alarm import make_alarm
from tests.interrupted import broken_off

RUNNING = MachineReading(
    {
        "avail": "AVAILABLE",
        "execution": "ACTIVE",
        "mode": "AUTOMATIC",
        "estop": "ARMED",
        "program": "pin.nc",
        "pcount": "12",
    },
    {"system": (), "Xservo": (("FAULT", "102", "FOLLOWING ERROR: X"),)},
    alarms=(make_alarm("following", "X", 4, 0.0),),
)


class Hours:
    """A clock on the wall, a second a look."""

    def __init__(self) -> None:
        self.seconds = 0

    def __call__(self) -> str:
        self.seconds += 1
        return f"2026-01-01T00:00:{self.seconds:02}Z"


def read(path: Path) -> dict[str, object]:
    make_alarm: dict[str, object] = json.loads(path.read_text(encoding="utf-8"))
    return make_alarm


def test_status_of_interrupted_job_has_line_tool_part_and_time() -> None:
    status = make_status("GT-75", replace(RUNNING, interrupted_job=broken_off(line=8, tool=3, part=5)))
    assert status["interrupted"] == {"line": 8, "tool": 3, "part": 5, "at": "2026-05-04T09:30:00Z"}


def test_status_file_has_expected_content(tmp_path: Path) -> None:
    path = tmp_path / "home" / "status.json"
    StatusFileWriter(path, Hours()).write_status(make_status("GT-75", RUNNING))
    assert read(path) == {
        "updated": "2026-01-01T00:00:01Z",
        "since": "2026-01-01T00:00:01Z",
        "machine": "GT-75",
        "available": True,
        "execution": "ACTIVE",
        "mode": "AUTOMATIC",
        "estop": "ARMED",
        "program": "pin.nc",
        "parts": 12,
        "spindle_load": None,
        "interrupted": None,
        "alarms": [
            {
                **{"of": "Xservo", "level": "FAULT", "code": "102", "text": "FOLLOWING ERROR: X"},
                **{"number": 102, "cause": "X", "remedy": CATALOG["following"].remedy, "line": 4},
            }
        ],
    }
    assert [each.name for each in path.parent.iterdir()] == ["status.json"]


@pytest.mark.parametrize(("load", "told"), [(42.6, 45), (41.9, 40), (0.0, 0), (None, None)])
def test_spindle_load_is_rounded_to_steps_to_limit_disk_writes(load: float | None, told: int | None) -> None:
    reading = replace(RUNNING, values={**RUNNING.values, "Sload": load})
    assert make_status("GT-75", reading)["spindle_load"] == told


def test_status_of_silent_control_has_no_values() -> None:
    status = make_status("GT-75", MachineReading({"avail": "UNAVAILABLE"}))
    assert (status["available"], status["execution"], status["parts"]) == (False, None, None)


def test_status_is_written_on_change_and_every_ten_polls(tmp_path: Path) -> None:
    path, hours = tmp_path / "status.json", Hours()
    file = StatusFileWriter(path, hours)
    for _ in range(10):
        file.write_status({"execution": "ACTIVE"})
    assert hours.seconds == 1
    file.write_status({"execution": "ACTIVE"})
    assert read(path) == {
        "updated": "2026-01-01T00:00:02Z",
        "since": "2026-01-01T00:00:01Z",
        "execution": "ACTIVE",
    }
    file.write_status(
        {"execution": "ACTIVE", "parts": 1}
    )  # another part: since then it has been active all the same
    assert read(path)["since"] == "2026-01-01T00:00:01Z"
    file.write_status({"execution": "STOPPED"})
    assert read(path)["since"] == read(path)["updated"] == "2026-01-01T00:00:04Z"


def test_disk_error_is_reported_once_and_write_is_retried(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "home").write_text("a file where the folder should be")
    file = StatusFileWriter(tmp_path / "home" / "status.json", Hours())
    for _ in range(3):
        file.write_status({"execution": "ACTIVE"})
    assert len(caplog.records) == 1
    assert "status.json" in caplog.text
    (tmp_path / "home").unlink()
    file.write_status({"execution": "ACTIVE"})
    assert read(tmp_path / "home" / "status.json")["execution"] == "ACTIVE"


def test_partly_written_file_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "status.json").write_text('{"upda')
    (tmp_path / "status.json.new").write_text("rubbish")
    StatusFileWriter(tmp_path / "status.json", Hours()).write_status({"execution": "READY"})
    assert read(tmp_path / "status.json")["execution"] == "READY"


def test_reader_during_write_sees_a_complete_file(tmp_path: Path) -> None:
    path = tmp_path / "status.json"
    file = StatusFileWriter(path, lambda: "now")
    file.write_status({"parts": 0})
    over = threading.Event()

    def write() -> None:
        for parts in range(1, 300):
            file.write_status({"parts": parts})
        over.set()

    writer = threading.Thread(target=write)
    writer.start()
    seen = [read(path)["parts"]]
    while not over.is_set():
        seen.append(read(path)["parts"])
    writer.join()
    assert seen == sorted(seen)  # type: ignore[type-var]


def test_closed_status_updater_reports_unavailable_and_ends_thread(tmp_path: Path) -> None:
    looked = threading.Event()

    def look() -> StatusDocument:
        looked.set()
        return {"execution": "READY"}

    path = tmp_path / "status.json"
    keeper = StatusFileUpdater(StatusFileWriter(path, Hours()), look, {"available": False})
    keeper.start()
    assert looked.wait(60.0)
    keeper.close()
    assert read(path)["available"] is False
    assert [thread.name for thread in threading.enumerate() if thread.name == "status"] == []
    keeper.close()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_internal_error_is_reported_in_status_file(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    def look() -> StatusDocument:
        raise RuntimeError("a mistake of our own")

    keeper = StatusFileUpdater(
        StatusFileWriter(tmp_path / "status.json", Hours()), look, {"available": False}
    )
    keeper.start()
    for thread in threading.enumerate():
        if thread.name == "status":
            thread.join()
    assert read(tmp_path / "status.json")["available"] is False
    assert "RuntimeError: a mistake of our own" in caplog.text
