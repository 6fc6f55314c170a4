"""The page for the office, of a morning that is made up, for the pictures of the guide."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from app.compose.machine.machine_files import load_machine
from app.compose.stored_offsets import read_offsets, setup_with
from app.compose.workshop import samples, thumbnails
from app.desk.kept_part import kept_part
from app.extras.office.office_desk import PICTURE
from app.extras.office.office_pictures import png_of
from app.extras.office.page_server import PageServer, listening_at
from app.extras.office.status_page import OtherDesk, StatusPage
from app.shopfloor.status_file import Status
from core.executor.job import make_job
from core.language.source import load_source

STATUS: Status = {
    "updated": "2026-03-02T09:41:07+00:00", "machine": "GT-75", "available": True, "program": "bushing.nc",
    "state": "RUNNING", "waiting_for": "", "line": 26, "made": 57, "time_left": 31.0, "last_cycle": 49.4,
    "spindle_load": 35, "stop": "", "alarms": [],
    "stops": [
        {"at": "2026-03-02T08:57:31+00:00", "reason": "BETWEEN CYCLES", "seconds": 1500},
        {"at": "2026-03-02T08:24:02+00:00", "reason": "FEED HOLD", "seconds": 95},
    ],
}  # fmt: skip
OTHERS = (
    OtherDesk(
        "lathe2:8317", {"machine": "LATHE 2", "state": "FEED HOLD", "program": "grooves.nc", "made": 41}
    ),
    OtherDesk("LATHE 3 (lathe3:8317)", trouble="Connection refused"),
)


def served() -> Iterator[tuple[str, str, tuple[int, int]]]:
    """Yield the file of the picture, the address of the page, and the size of the browser in pixels."""
    machine = load_machine(None)
    setup = setup_with(machine, read_offsets(samples() / "offsets.toml"))
    job = make_job(load_source(samples() / "bushing.nc"), setup)
    draw = thumbnails(machine, dict, partial(kept_part, lambda _key: None), size=PICTURE)
    drawn = draw(job, lambda _done: None)
    part = png_of(drawn.pixels, drawn.width, drawn.height) if drawn is not None else b""
    page = StatusPage("GT-75", "", lambda: STATUS, lambda: OTHERS, lambda: part, lambda: b"")
    listening = listening_at("127.0.0.1", 0)
    server = PageServer(page, listening, lambda: None)
    server.start()
    yield "office.png", f"http://127.0.0.1:{listening.getsockname()[1]}/", (740, 1060)
    server.close()
