"""Pictures of the page of shared programs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.compose.program_proving import get_samples_folder
from app.compose.runs.journal import Journal
from app.desk.desk import Desk
from app.extras.sharing.sharing import ProgramSharing
from app.extras.sharing.sharing_model import SharingModel
from app.screen.page_base import Page
from core.extras.sharing.shared_folder import SharedFolder
from core.store.store import Store

SCENES = (("sharing", "F1 X", "jobs"),)
SHARED = ("bushing.nc", "grooves.nc", "knob.nc")


def prepare(desk: Desk, journal: Journal, folder: Path) -> None:
    """Three programs that both lathes have, of which LATHE 2 has made one better since."""
    shop, here, there = (folder / name for name in ("shop", "here", "there"))
    for each in (shop, here, there / "programs"):
        each.mkdir(parents=True)
    for name in SHARED:
        (here / name).write_bytes((get_samples_folder() / name).read_bytes())
    SharedFolder(shop).set_up()
    made = ProgramSharing(SharedFolder(shop), "LATHE 1", "1" * 32, here, journal.require_store)
    made.synchronize()
    with Store.open(there) as store:
        other = ProgramSharing(SharedFolder(shop), "LATHE 2", "2" * 32, there / "programs", lambda: store)
        for family in other.synchronize().versions_by_program.values():
            other.copy_version(family.newest_versions[0])
        better = there / "programs" / SHARED[0]
        better.write_bytes(better.read_bytes().replace(b"G95F.008", b"G95F.010"))
        other.synchronize()
    made.synchronize()
    before = desk.page_registry.find_model(SharingModel)
    if before is not None:
        before.close()
    desk.page_registry.attach_model(SharingModel(desk, made))


def settle(_page: Page | None, _wait: Callable[[], None]) -> None:
    """Wait for nothing: the page shows at once what it knows."""
