"""Who may take a shared program on the screen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.extras.sharing.sharing import ProgramSharing
from app.extras.sharing.sharing_model import SharingModel
from core.extras.sharing.shared_folder import SharedFolder
from core.store.store import Store
from tests.desk.levels_room import LIMIT, Room, room
from tests.texts import shows
from tests.texts import text as wording

__all__ = ["room"]


def shared(room: Room, tmp_path: Path) -> SharingModel:
    """Another desk has published PEG, which this one does not have; it is marked."""
    (tmp_path / "shop").mkdir()
    (tmp_path / "other" / "programs").mkdir(parents=True)
    (tmp_path / "other" / "programs" / "peg.nc").write_text("M30\n")
    place = SharedFolder(tmp_path / "shop")
    place.set_up()
    with Store.open(tmp_path / "other") as store:
        ProgramSharing(
            place, "LATHE 2", "2" * 32, tmp_path / "other" / "programs", lambda: store
        ).synchronize()
    own = tmp_path / "home" / "programs"
    sharing = ProgramSharing(place, "LATHE 1", "1" * 32, own, room.journal.require_store)
    sharing.synchronize()
    model = SharingModel(room.desk, sharing)
    for _ in range(3):
        model.update()
        model.worker.wait_for_results(LIMIT)
    assert model.selected_version is not None
    return model


def test_copying_a_shared_program_requires_setup_level(room: Room, tmp_path: Path) -> None:
    room.enter_people()
    model, peg = shared(room, tmp_path), tmp_path / "home" / "programs" / "peg.nc"
    model.copy_version()
    model.worker.wait_for_results(LIMIT)
    assert shows(room.desk.prompt_notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    assert not peg.exists()
    room.sign_in("BEN")
    model.copy_version()
    model.worker.wait_for_results(LIMIT)
    assert peg.read_text() == "M30\n"
    assert room.log("change")[-1] == (wording("log.taken-as", name="peg.nc", desk="LATHE 2"), "BEN")
    model.close()


def test_level_is_checked_again_on_copy_and_the_user_is_logged(room: Room, tmp_path: Path) -> None:
    room.enter_people()
    page, peg = shared(room, tmp_path), tmp_path / "home" / "programs" / "peg.nc"
    version = page.selected_version
    assert version is not None
    changes: tuple[Callable[[], object], ...] = (
        lambda: page._take(version),
        lambda: page._keep("peg.nc", "peg.nc"),
    )
    for refused in changes:
        room.desk.clear_prompt_line()  # what was asked is answered when the level has fallen back
        refused()
        page.worker.wait_for_results(LIMIT)
        assert shows(room.desk.prompt_notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    assert not peg.exists()
    room.sign_in("BEN")
    page._take(version)
    room.access.sign_out()
    page.worker.wait_for_results(LIMIT)
    assert peg.read_text() == "M30\n"
    assert room.log("change") == [(wording("log.taken-as", name="peg.nc", desk="LATHE 2"), "BEN")]
    page.close()
