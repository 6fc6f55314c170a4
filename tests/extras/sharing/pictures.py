"""Pictures of the page of shared programs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.compose.runs.journal import Journal
from app.compose.workshop import samples
from app.desk.desk import Desk
from app.extras.sharing.sharing import Sharing
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
        (here / name).write_bytes((samples() / name).read_bytes())
    SharedFolder(shop).begin()
    made = Sharing(SharedFolder(shop), "LATHE 1", "1" * 32, here, journal.opened)
    made.look()
    with Store.open(there) as store:
        other = Sharing(SharedFolder(shop), "LATHE 2", "2" * 32, there / "programs", lambda: store)
        for family in other.look().families.values():
            other.take(family.newest[0])
        better = there / "programs" / SHARED[0]
        better.write_bytes(better.read_bytes().replace(b"G95F.008", b"G95F.010"))
        other.look()
    made.look()
    before = desk.pages.find(SharingModel)
    if before is not None:
        before.close()
    desk.pages.attach(SharingModel(desk, made))


def settle(_page: Page | None, _wait: Callable[[], None]) -> None:
    """Wait for nothing: the page shows at once what it knows."""
