"""``turndesk share``: two desks by the command line, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import resources
from app.compose.backends.machine_check import check_machine
from app.compose.machine.machine_files import parse_machine
from app.extras.sharing import share_command
from core.store.store import Store
from core.table_schema import MachineFileError
from tests.cli.conftest import Told, Turndesk, home, turndesk
from tests.cli.json_output import declared_alone, whole
from tests.coded import raises_code
from tests.texts import begins

__all__ = ["home", "turndesk"]


class Shop:
    """Two desks of one computer: data folders and machine files of their own, one shared folder."""

    def __init__(self, folder: Path, turndesk: Turndesk, patch: pytest.MonkeyPatch) -> None:
        self.folder, self._turndesk, self._patch = folder, turndesk, patch
        (folder / "shop").mkdir()
        for number in (1, 2):
            (folder / f"home{number}" / "programs").mkdir(parents=True)
            self.sharing(number, f'folder = "{folder / "shop"}"\ndesk = "LATHE {number}"\n')

    def sharing(self, number: int, table: str) -> None:
        text = resources.read_machine_file("gt75.toml") + f"\n[sharing]\n{table}"
        (self.folder / f"lathe{number}.toml").write_text(text)

    def program(self, number: int, name: str) -> Path:
        return self.folder / f"home{number}" / "programs" / name

    def share(self, number: int, *words: str) -> Told:
        self._patch.setenv("TURNDESK_HOME", str(self.folder / f"home{number}"))
        return self._turndesk("share", *words, "--machine", str(self.folder / f"lathe{number}.toml"))


@pytest.fixture
def shop(tmp_path: Path, turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch) -> Shop:
    made = Shop(tmp_path, turndesk, monkeypatch)
    assert made.share(1, "begin")[1].endswith("is set up for shared programs\n")
    return made


def test_program_is_published_compared_copied_and_resolved(shop: Shop) -> None:
    shop.program(1, "CAP.NC").write_text("G00 X1\nM30\n")
    assert shop.share(1, "publish")[1].endswith("contains the only program from LATHE 1\n")
    told = json.loads(shop.share(2, "status", "--json")[1])
    (program,) = told["programs"]
    assert (program["program"], program["state"], program["here"]) == ("CAP.NC", "new", None)
    assert (program["elsewhere"][0]["desk"], program["elsewhere"][0]["on"]) == ("LATHE 1", ["LATHE 1"])
    assert not (shop.folder / "home2" / "turndesk.db").exists()  # a look keeps nothing
    taken = shop.share(2, "take", "cap.nc")[1]
    assert begins(taken, "cli.version-taken", name="CAP.NC", desk="LATHE 1")
    assert shop.program(2, "CAP.NC").read_text() == "G00 X1\nM30\n"
    for number in (1, 2):
        shop.program(number, "CAP.NC").write_text(f"G00 X1{number}\nM30\n")
        shop.share(number, "publish")
    assert "changed on this control and elsewhere" in shop.share(1, "status")[1]
    assert shop.share(1, "compare", "CAP.NC")[1] == (
        "    1       - G00 X11\n          1 + G00 X12\n    2     2   M30\n"
    )
    assert shop.share(1, "keep", "CAP.NC")[1] == "the local version of CAP.NC is used\n"
    assert shop.share(2, "take", "CAP.NC")[0] == 0
    assert shop.program(2, "CAP.NC").read_text() == "G00 X11\nM30\n"
    with Store.open(shop.folder / "home2", read_only=True) as store:
        kept = {
            store.programs.load_version("CAP.NC", row.number)
            for row in store.programs.list_versions("CAP.NC")
        }
    assert kept == {b"G00 X1\nM30\n", b"G00 X12\nM30\n", b"G00 X11\nM30\n"}


@pytest.mark.parametrize(
    ("words", "code", "value"),
    [
        (("take", "GONE.NC"), "not-shared-program", "GONE.NC"),
        (("take", "CAP.NC"), "nothing-newer", "CAP.NC"),
        (("take", "CAP.NC", "--id", "zz"), "no-one-version", "zz"),
        (("keep", "CAP.NC"), "nothing-to-settle", ""),
        (("keep", "GONE.NC"), "nothing-to-settle", ""),
    ],
)
def test_invalid_commands_are_rejected(shop: Shop, words: tuple[str, ...], code: str, value: str) -> None:
    shop.program(1, "CAP.NC").write_text("G00 X1\n")
    shop.share(1, "publish")
    told = shop.share(1, *words)
    assert (told.status, told.out, told.code, told.err.count("\n")) == (2, "", code, 1)
    assert value in told.err


def test_unmounted_folder_is_reported_in_one_sentence(shop: Shop) -> None:
    (shop.folder / "shop").rename(shop.folder / "unmounted")
    told = shop.share(1, "status", "--json")
    assert (told.status, json.loads(told.out)["waiting"]) == (1, 0)
    assert shop.share(1, "publish").status == 2
    (shop.folder / "shop").mkdir()  # the empty mount point: nothing is laid out in it unasked
    told = shop.share(1, "publish")
    assert (told.status, str(shop.folder / "shop") in told.err) == (2, True)
    assert list((shop.folder / "shop").iterdir()) == []


def test_new_computer_can_claim_the_name_of_the_old_one(shop: Shop) -> None:
    shop.program(1, "CAP.NC").write_text("G00 X1\n")
    shop.share(1, "publish")
    shop.sharing(2, f'folder = "{shop.folder / "shop"}"\ndesk = "Lathe 1"\n')
    told = shop.share(2, "publish")
    assert (told.status, "--claim" in told.err) == (2, True)
    assert shop.share(2, "publish", "--claim")[0] == 0
    assert shop.share(2, "publish")[0] == 0
    assert len(list((shop.folder / "shop" / "desks").iterdir())) == 1


def test_publish_command_is_rejected_while_turndesk_runs(shop: Shop) -> None:
    with Store.open(shop.folder / "home1"):
        told = shop.share(1, "publish")
        assert (told.status, told.code) == (2, "in-use")
        assert shop.share(1, "status")[0] == 0


def test_machine_file_without_a_sharing_location_is_rejected(turndesk: Turndesk) -> None:
    told = turndesk("share", "status")
    assert (told.status, told.code) == (2, "no-sharing")


@pytest.mark.parametrize(
    ("table", "code", "value"),
    [
        ("", "many-places", "folder and postgresql"),
        ('folder = "/a"\npostgresql = "b"', "many-places", "= folder and postgresql"),
        ('git = "ssh://shop-pc/x.git"', "removed-key", "sharing.git"),
        ('git = 7\nfolder = "/a"', "removed-key", "sharing.git"),
        (f'folder = "/a"\ndesk = "{"x" * 41}"', "name-too-long", "40"),
        ('folder = "/a"\nlook = 1', "wrong-value", "sharing.look"),
        ('folder = "/a"\npassword = "x"', "unknown-key", "sharing.password"),
    ],
)
def test_invalid_sharing_tables_are_rejected(table: str, code: str, value: str) -> None:
    with raises_code(MachineFileError, code, value):
        parse_machine(resources.read_machine_file("gt75.toml") + f"[sharing]\n{table}\n", "m.toml")


def test_machine_check_has_a_row_for_the_location(shop: Shop) -> None:
    shop.share(1, "publish")
    for name, state in (("shop", "ok"), ("gone", "no answer")):
        table = f'[sharing]\nfolder = "{shop.folder / name}"\n'
        machine = parse_machine(resources.read_machine_file("gt75.toml") + table, "m.toml")
        (row,) = (row for row in check_machine(machine).rows if row.name == "sharing")
        assert (row.state, "LATHE 1" in row.detail) == (state, state == "ok")


def test_share_json_output_has_the_declared_keys(shop: Shop) -> None:
    begun = whole(shop.share(1, "begin", "--json"))
    declared_alone([begun], share_command.SHARE_BEGIN_OUTPUT.keys)
    shop.program(1, "CAP.NC").write_text("G00 X1\nM30\n")
    shop.program(1, "LARGE.NC").write_bytes(b"(X)\n" * (9 * 2**20))
    shared = [whole(shop.share(1, "publish", "--json"))]
    (shop.folder / "shop" / "stray.txt").write_text("X")
    taken = whole(shop.share(2, "take", "CAP.NC", "--json"))
    declared_alone([taken], share_command.SHARE_COPY_OUTPUT.keys)
    for number in (1, 2):
        shop.program(number, "CAP.NC").write_text(f"G00 X1{number}\nM30\n")
        shop.share(number, "publish")
    shared.append(whole(shop.share(1, "status", "--json")))
    declared_alone(shared, share_command.SHARE_STATUS_OUTPUT.keys)
    declared_alone(
        [whole(shop.share(1, "compare", "CAP.NC", "--json"))], share_command.SHARE_COMPARE_OUTPUT.keys
    )
    declared_alone([whole(shop.share(1, "keep", "CAP.NC", "--json"))], share_command.SHARE_KEEP_OUTPUT.keys)
