"""Two desks that share programs: apart and together again, by version and never by the clock."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import pytest

from app.extras.sharing import sharing as sharing_module
from app.extras.sharing.sharing import ProgramSharing, VersionCopyError
from app.programs import atomic_files
from app.programs.atomic_files import FileOperationError
from core.extras.sharing.shared_location import PublishedVersion, SharingError
from core.extras.sharing.shared_versions import ProgramVersions, SharedVersion
from core.extras.sharing.version_record import PublishedMachineState
from tests.coded import raises_code
from tests.extras.sharing.conftest import MakeDesk
from tests.extras.sharing.rigs import PowerCut, Rig
from tests.extras.sharing.test_places import published, state


def write(desk: ProgramSharing, text: str, name: str = "PART.NC") -> None:
    (folder_of(desk) / name).write_text(text)


def read(desk: ProgramSharing, name: str = "PART.NC") -> str:
    return (folder_of(desk) / name).read_text()


def folder_of(desk: ProgramSharing) -> Path:
    return desk._files.folder


def family(desk: ProgramSharing, key: str = "part.nc") -> ProgramVersions:
    return desk.last_result.versions_by_program[key]


def together(*desks: ProgramSharing) -> None:
    """Each hears of what all others have."""
    for desk in (*desks, *desks):
        shared = desk.synchronize()
        assert (shared.error_text, shared.unpublished_version_count) == ("", 0)


def only(desk: ProgramSharing) -> SharedVersion:
    (version,) = family(desk).newest_remote_versions
    return version


# --- in every kind of place -----------------------------------------------------------------------------


def test_local_change_is_newer_elsewhere_until_copied(desk: MakeDesk) -> None:
    one, two = desk(1), desk(2)
    write(one, "G00 X1\n")
    together(one, two)
    assert (family(two).sharing_state, (folder_of(two) / "PART.NC").exists()) == (
        "new",
        False,
    )  # never unasked
    two.copy_version(only(two))
    together(two, one)
    assert (read(two), family(two).sharing_state, family(one).sharing_state) == ("G00 X1\n", "same", "same")
    assert one.last_result.find_machines_with_version(family(one).local_version_id) == ("LATHE 1", "LATHE 2")
    write(one, "G00 X2\n")
    together(one, two)
    assert (family(two).sharing_state, read(two)) == ("newer", "G00 X1\n")
    assert one.last_result.find_machines_with_version(family(one).local_version_id) == ("LATHE 1",)
    two.copy_version(only(two))
    assert read(two) == "G00 X2\n"


def test_machines_apart_for_a_day_retain_both_versions_and_resolve_once(rig: Rig, desk: MakeDesk) -> None:
    one, two = desk(1), desk(2)
    write(one, "G00 X1\n")
    together(one, two)
    two.copy_version(only(two))
    together(two, one)
    rig.leave()
    for hour in range(3):
        write(one, f"G00 X1{hour}\n")
        write(two, f"G00 X2{hour}\n")
        assert one.synchronize().error_text
        assert (two.synchronize().unpublished_version_count, two.last_result.error_text.count("\n")) == (
            hour + 1,
            0,
        )
    rig.come_back()
    together(one, two)
    assert (family(one).sharing_state, family(two).sharing_state) == ("both", "both")
    assert (read(one), read(two)) == ("G00 X12\n", "G00 X22\n")
    two.copy_version(only(two))
    together(two, one)
    assert (read(two), family(two).sharing_state) == ("G00 X12\n", "same")
    assert family(one).sharing_state == "newer"  # by lineage; the text is that of this desk
    one.copy_version(only(one))
    together(one, two)
    assert (family(one).sharing_state, family(two).sharing_state, read(one)) == ("same", "same", "G00 X12\n")
    kept = {one.read_version_text(each) for each in family(one).versions.values()}
    assert kept == {b"G00 X1\n", *(b"G00 X%d%d\n" % (d, hour) for d in (1, 2) for hour in range(3))}


def test_interrupted_publishing_loses_nothing(
    rig: Rig, desk: MakeDesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, two = desk(1), desk(2)
    write(one, "G00 X0\n", "FIRST.NC")
    together(one)
    for number in range(5):
        write(one, f"G00 X{number}\n", f"PART{number}.NC")
    with monkeypatch.context() as patch:
        rig.cut_in_put(patch)
        with suppress(PowerCut):
            assert one.synchronize().error_text
    rig.mend()
    together(one, two)
    found = {
        key: two.read_version_text(each.newest_versions[0])
        for key, each in two.last_result.versions_by_program.items()
    }
    assert found == {"first.nc": b"G00 X0\n"} | {f"part{n}.nc": b"G00 X%d\n" % n for n in range(5)}


# --- where the kind does not matter ---------------------------------------------------------------------


def test_local_version_can_win_over_a_remote_change(desk_at_folder: MakeDesk) -> None:
    one, two = _both_changed(desk_at_folder)
    one.resolve_with_local_version("part.nc")
    together(one, two)
    assert (family(one).sharing_state, read(one)) == ("same", "ONE\n")
    assert (family(two).sharing_state, read(two)) == ("newer", "TWO\n")
    two.copy_version(only(two))
    assert read(two) == "ONE\n"
    with raises_code(VersionCopyError, "nothing-to-settle"):
        one.resolve_with_local_version("part.nc")


def _both_changed(desk: MakeDesk) -> tuple[ProgramSharing, ProgramSharing]:
    one, two = desk(1), desk(2)
    write(one, "G00\n")
    together(one, two)
    two.copy_version(only(two))
    write(one, "ONE\n")
    write(two, "TWO\n")
    together(one, two)
    assert family(one).sharing_state == "both"
    return one, two


def test_wrong_clock_has_no_effect(desk_at_folder: MakeDesk, monkeypatch: pytest.MonkeyPatch) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    monkeypatch.setattr(sharing_module, "get_utc_now_text", lambda: "2041-01-01T00:00:00.000Z")
    write(one, "OLD\n")
    together(one)
    monkeypatch.setattr(sharing_module, "get_utc_now_text", lambda: "1999-01-01T00:00:00.000Z")
    together(two)
    two.copy_version(only(two))
    write(two, "NEW\n")
    together(two, one)
    assert (family(one).sharing_state, only(one).saved) == ("newer", "1999-01-01T00:00:00.000Z")
    one.copy_version(only(one))
    assert read(one) == "NEW\n"


def test_returning_to_an_old_text_is_a_newer_version(desk_at_folder: MakeDesk) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    for text in ("A\n", "B\n"):
        write(one, text)
        together(one, two)
        two.copy_version(only(two))
    write(two, "A\n")
    together(two, one)
    assert family(one).sharing_state == "newer"
    one.copy_version(only(one))
    assert read(one) == "A\n"


def test_same_text_on_two_machines_is_one_version(desk_at_folder: MakeDesk) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    write(one, "G00\n")
    write(two, "G00\n")  # brought on a stick
    together(one, two)
    assert (family(two).sharing_state, len(family(two).versions)) == ("same", 1)


def test_two_programs_of_the_same_name_are_both_retained(desk_at_folder: MakeDesk) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    write(one, "BOLT\n")
    one.synchronize()
    write(two, "NUT\n")
    together(two, one)
    assert (family(one).sharing_state, family(two).sharing_state) == ("both", "both")
    assert (read(one), read(two)) == ("BOLT\n", "NUT\n")


def test_names_that_differ_only_in_case_are_one_program(desk_at_folder: MakeDesk) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    write(one, "G00\n", "Part.nc")
    together(one, two)
    two.copy_version(only(two))
    (folder_of(two) / "Part.nc").rename(folder_of(two) / "PART.NC")
    write(one, "G01\n", "Part.nc")
    together(one, two)
    assert two.copy_version(only(two)) == "PART.NC"
    assert [path.name for path in folder_of(two).iterdir()] == ["PART.NC"]
    write(two, "ELSE\n", "part.NC")
    shared = two.synchronize()
    assert set(shared.rejected_files) == {"PART.NC", "part.NC"}
    write(one, "G02\n", "Part.nc")
    together(one)
    two.synchronize()
    with raises_code(VersionCopyError, "refused-name"):
        two.copy_version(only(two))
    assert (read(two, "PART.NC"), read(two, "part.NC")) == ("G01\n", "ELSE\n")


@pytest.mark.parametrize("name", ["NUL.nc", "Aux.NC"])
def test_shared_version_with_a_name_windows_reserves_is_listed_but_not_copied(
    folder_rig: Rig, desk_at_folder: MakeDesk, name: str
) -> None:
    """An earlier TurnDesk has published the version. It is not damaged."""
    earlier = published(1, name)
    folder_rig.place(3).publish_versions([earlier], state(earlier))
    one = desk_at_folder(1)
    together(one)
    (shared,) = family(one, name.lower()).newest_remote_versions
    assert shared == earlier.version
    with raises_code(VersionCopyError, "device-name", repr(name)):
        one.copy_version(shared)
    assert list(folder_of(one).iterdir()) == []


def test_local_file_with_a_name_windows_reserves_is_not_shared(desk_at_folder: MakeDesk) -> None:
    one = desk_at_folder(1)
    write(one, "G00\n", "NUL.nc")
    write(one, "G00\n")
    shared = one.synchronize()
    assert (set(shared.rejected_files), set(shared.versions_by_program)) == ({"NUL.nc"}, {"part.nc"})


def test_locally_deleted_program_remains_on_the_others(desk_at_folder: MakeDesk) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    write(one, "G00\n")
    together(one, two)
    two.copy_version(only(two))
    (folder_of(one) / "PART.NC").unlink()
    together(one, two)
    assert (family(one).sharing_state, family(two).sharing_state, read(two)) == ("new", "same", "G00\n")
    assert one.last_result.find_machines_with_version(family(two).local_version_id) == ("LATHE 2",)


def test_file_being_written_is_skipped_until_settled(desk_at_folder: MakeDesk) -> None:
    one = desk_at_folder(1)
    write(one, "G00\n")
    one.synchronize(is_settled=True)
    write(one, "G00\nG01 X")
    one.synchronize(is_settled=True)
    assert len(family(one).versions) == 1
    write(one, "G00\nG01 X1\n")
    one.synchronize(is_settled=True)
    one.synchronize(is_settled=True)
    assert {one.read_version_text(each) for each in family(one).versions.values()} == {
        b"G00\n",
        b"G00\nG01 X1\n",
    }


def test_two_machines_with_one_id_are_rejected_and_publish_nothing(desk_at_folder: MakeDesk) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    write(one, "G00\n")
    one.synchronize()
    two.machine_name = "lathe 1"
    write(two, "G01\n", "OTHER.NC")
    shared = two.synchronize()
    assert (shared.unpublished_version_count, "--claim" in shared.error_text) == (1, True)
    two.machine_id = one.machine_id  # claimed: that computer is gone
    assert two.synchronize().error_text == ""


def test_failed_write_leaves_everything_unchanged(
    desk_at_folder: MakeDesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, two = _both_changed(desk_at_folder)

    def full(_path: Path, _data: bytes) -> None:
        raise FileOperationError("PART.NC CANNOT BE WRITTEN: No space left on device", "cannot-write")

    with monkeypatch.context() as patch:
        patch.setattr(sharing_module, "write_program_file", full)
        with raises_code(VersionCopyError, "cannot-write", os.strerror(errno.ENOSPC)):
            two.copy_version(only(two))
    together(two, one)
    assert (family(one).sharing_state, family(two).sharing_state, read(two)) == ("both", "both", "TWO\n")
    assert len(family(one).versions) == 3


@pytest.mark.parametrize("before", [True, False])
def test_next_synchronization_recovers_from_a_power_cut_while_copying(
    desk_at_folder: MakeDesk, monkeypatch: pytest.MonkeyPatch, *, before: bool
) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    write(one, "A\n")
    together(one, two)
    two.copy_version(only(two))
    write(one, "B\n")
    together(one, two)

    def cut(path: Path, data: bytes) -> None:
        if not before:
            atomic_files.write_program_file(path, data)
        raise PowerCut

    with monkeypatch.context() as patch:
        patch.setattr(sharing_module, "write_program_file", cut)
        with pytest.raises(PowerCut):
            two.copy_version(only(two))
    together(two, one)
    assert len(family(one).versions) == 2  # nothing was made up
    assert (family(two).sharing_state, read(two)) == (("newer", "A\n") if before else ("same", "B\n"))


def test_version_without_its_text_is_not_copied(folder_rig: Rig, desk_at_folder: MakeDesk) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    write(one, "G00\n")
    together(one, two)
    folder_rig.leave()
    with raises_code(SharingError, "not-there"):
        two.copy_version(only(two))
    assert list(folder_of(two).iterdir()) == []
    folder_rig.come_back()
    two.copy_version(only(two))
    with raises_code(VersionCopyError, "already-current"):
        two.copy_version(family(two).newest_versions[0])


def test_version_removed_from_the_location_is_published_again(
    folder_rig: Rig, desk_at_folder: MakeDesk
) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    write(one, "G00\n")
    together(one)
    for file in (folder_rig.folder / "shop" / "versions").iterdir():
        file.unlink()
    together(one, two)
    assert two.read_version_text(only(two)) == b"G00\n"


def test_thousand_programs_synchronize_in_one_pass_each(
    desk_at_folder: MakeDesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, two = desk_at_folder(1), desk_at_folder(2)
    monkeypatch.setattr("os.fsync", lambda _file: None)  # a thousand files to the disk, elsewhere shown
    for number in range(1000):
        write(one, f"G00 X{number}\n", f"P{number:04d}.NC")
    one.synchronize()
    two.synchronize()
    assert len(two.last_result.versions_by_program) == 1000
    assert (
        two.read_version_text(two.last_result.versions_by_program["p0999.nc"].newest_versions[0])
        == b"G00 X999\n"
    )


def test_store_closed_by_a_restore_during_synchronization_is_reported(
    desk_at_folder: MakeDesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The store is closed while the last file goes to the place: the thread that looks has to live on."""
    one = desk_at_folder(1)
    write(one, "G00 X1\n")
    together(one)
    (folder_of(one) / "PART.NC").unlink()
    store, put = one._store(), one.location.publish_versions

    def closed_meanwhile(versions: Sequence[PublishedVersion], state: PublishedMachineState) -> None:
        put(versions, state)
        store.close()

    monkeypatch.setattr(one.location, "publish_versions", closed_meanwhile)
    assert "is closed" in one.synchronize().error_text
