"""The page for the office, of a morning that is made up, for the pictures of the guide."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from app.compose.machine.machine_files import load_machine
from app.compose.program_proving import create_thumbnail_drawer, get_samples_folder
from app.compose.stored_offsets import create_setup_with_offsets, read_offsets_file
from app.desk.stored_part import load_stored_part
from app.extras.office.office_pictures import encode_png
from app.extras.office.office_setup import PICTURE_SIZE
from app.extras.office.page_server import StatusPageServer, open_listening_socket
from app.extras.office.status_page import OtherMachine, StatusPage
from app.shopfloor.status_file import StatusDocument
from core.executor.job import make_job
from core.language.source import load_source

STATUS: StatusDocument = {
    "updated": "2026-03-02T09:41:07+00:00", "machine": "GT-75", "available": True, "program": "bushing.nc",
    "state": "RUNNING", "waiting_for": "", "line": 26, "made": 57, "time_left": 31.0, "last_cycle": 49.4,
    "spindle_load": 35, "stop": "", "alarms": [],
    "stops": [
        {"at": "2026-03-02T08:57:31+00:00", "reason": "BETWEEN CYCLES", "seconds": 1500},
        {"at": "2026-03-02T08:24:02+00:00", "reason": "FEED HOLD", "seconds": 95},
    ],
}  # fmt: skip
OTHERS = (
    OtherMachine(
        "lathe2:8317", {"machine": "LATHE 2", "state": "FEED HOLD", "program": "grooves.nc", "made": 41}
    ),
    OtherMachine("LATHE 3 (lathe3:8317)", error_text="Connection refused"),
)


def served() -> Iterator[tuple[str, str, tuple[int, int]]]:
    """Yield the file of the picture, the address of the page, and the size of the browser in pixels."""
    machine = load_machine(None)
    setup = create_setup_with_offsets(machine, read_offsets_file(get_samples_folder() / "offsets.toml"))
    job = make_job(load_source(get_samples_folder() / "bushing.nc"), setup)
    draw = create_thumbnail_drawer(
        machine, dict, partial(load_stored_part, lambda _key: None), size_px=PICTURE_SIZE
    )
    drawn = draw(job, lambda _done: None)
    part = encode_png(drawn.pixels, drawn.width_px, drawn.height_px) if drawn is not None else b""
    page = StatusPage("GT-75", "", lambda: STATUS, lambda: OTHERS, lambda: part, lambda: b"")
    listening = open_listening_socket("127.0.0.1", 0)
    server = StatusPageServer(page, listening, lambda: None)
    server.start()
    yield "office.png", f"http://127.0.0.1:{listening.getsockname()[1]}/", (740, 1060)
    server.close()
