"""What the pictures need beside the lathe: a drawing among the programs, and another lathe that shares."""

from __future__ import annotations

from pathlib import Path

import ezdxf

from app.compose.journal import Journal
from app.compose.workshop import samples
from app.desk.desk import Desk
from app.extras.sharing.sharing import Sharing
from app.extras.sharing.sharing_model import SharingModel
from core.extras.sharing.shared_folder import SharedFolder
from core.store.store import Store

DRAWING = "spigot.dxf"
# Inches, Z to the right, the axis below: a nose of .5, a taper of 30 degrees, a flange of 1.
NOSE, FLANGE = ((0, 0), (0, 0.25), (-0.5, 0.25)), ((-1, 0.5), (-1.25, 0.5), (-1.25, 0))
OUTLINE = (*NOSE, (-0.7165, 0.375), (-1, 0.375), *FLANGE)
INCH = 1  # $INSUNITS
SHARED = ("bushing.nc", "grooves.nc", "knob.nc")


def put_drawing(folder: Path) -> None:
    """A DXF of one closed outline into the program folder."""
    folder.mkdir(parents=True, exist_ok=True)
    drawing = ezdxf.filemanagement.new()
    drawing.header["$INSUNITS"] = INCH
    drawing.modelspace().add_lwpolyline(OUTLINE)
    drawing.saveas(folder / DRAWING)


def share_with_another(desk: Desk, journal: Journal, folder: Path) -> None:
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
    before = desk.attached(SharingModel)
    if before is not None:
        before.close()
    desk.attach(SharingModel(desk, made))
