"""``turndesk setup``: a machine's setup from desk to desk, whole or not at all; desktop entry, completion."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
import resource
import shutil
import stat
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn

import pytest

import resources
from app.cli.setup_command import SHELL_NAMES
from app.compose.machine import setup_archive
from tests.cli.conftest import Turndesk


@pytest.fixture
def saved(turndesk: Turndesk, home: Path, tmp_path: Path) -> Path:
    """A setup with an offset, a program and a machine file."""
    assert turndesk("offsets", "set", "T3", "x=1", "z=2").status == 0
    (home / "programs").mkdir()
    (home / "programs" / "part.nc").write_text("G90\nM30\n")
    lathe = tmp_path / "mine.toml"
    lathe.write_text(resources.read_machine_file("gt75.toml"))
    told = turndesk("setup", "save", tmp_path / "a.setup", "--machine", lathe)
    assert told.status == 0, told.err
    assert "programs: 1, machine file mine.toml" in told.out
    return tmp_path / "a.setup"


def test_saved_setup_is_restored_in_another_home(
    saved: Path, turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = tmp_path / "other"
    monkeypatch.setenv("TURNDESK_HOME", str(other))
    (other / "programs").mkdir(parents=True)
    (other / "programs" / "part.nc").write_text("(MINE)\n")
    told = turndesk("setup", "load", saved)
    assert told.status == 0, told.err
    assert "T3  X +1.00000" in turndesk("offsets", "show").out
    assert (other / "programs" / "part.nc").read_text() == "G90\nM30\n"
    (kept,) = (other / "programs").glob("part.nc.replaced-*")
    assert kept.read_text() == "(MINE)\n"
    assert turndesk("prove", other / "programs" / "part.nc", "--machine", other / "machines" / "mine.toml")
    assert f"--machine {other / 'machines' / 'mine.toml'}" in told.out


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot store these names")
@pytest.mark.parametrize("name", ["Smith Inc./pin.nc", "Aux/pin.nc", "NUL.nc"])
def test_program_whose_name_windows_reserves_is_saved_and_restored(
    saved: Path, turndesk: Turndesk, home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    (home / "programs" / name).parent.mkdir(exist_ok=True)
    (home / "programs" / name).write_text("G91\nM30\n")
    assert turndesk("setup", "save", saved).status == 0
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "other"))
    told = turndesk("setup", "load", saved)
    assert told.status == 0, told.err
    assert (tmp_path / "other" / "programs" / name).read_text() == "G91\nM30\n"


@pytest.mark.skipif(sys.platform == "win32", reason="Windows keeps its own rights")
def test_saved_setup_is_readable_by_owner_only(saved: Path) -> None:
    assert stat.S_IMODE(saved.stat().st_mode) == 0o600


def test_setup_load_check_changes_nothing(
    saved: Path, turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "other"))
    assert "is undamaged" in turndesk("setup", "load", saved, "--check").out
    assert not (tmp_path / "other").exists()


MANIFESTS = {
    "outside": (b"programs/part.nc", b"programs/../../p"),
    "newer": (b"turndesk setup 1", b"turndesk setup 2"),
    "listed": (b'"store.db":', b'"a": ["store.db"], "b":'),
    "bare": (b"{", b"[{"),
}


@pytest.mark.parametrize(
    ("what", "code"),
    [
        ("cut", "damaged-setup"),
        ("changed", "damaged-member"),
        ("foreign", "damaged-setup"),
        ("outside", "foreign-member"),
        ("nothing", "unreadable"),
        ("newer", "other-version"),
        ("listed", "not-a-setup"),
        ("torn", "damaged-setup"),
        ("half", "damaged-setup"),
        ("bare", "damaged-setup"),
    ],
)
def test_damaged_setup_is_rejected_and_changes_nothing(
    what: str, code: str, saved: Path, turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bad = tmp_path / "bad.setup"
    if what == "cut":
        bad.write_bytes(saved.read_bytes()[:-200])
    elif what in {"torn", "half"}:
        _spoil(saved, bad, half=what == "half")
    elif what == "changed" or what in MANIFESTS:
        with zipfile.ZipFile(saved) as old, zipfile.ZipFile(bad, "w") as new:
            for name in old.namelist():
                data = old.read(name)
                if what == "changed" and name.endswith("part.nc"):
                    data = b"G90\nX1\n"
                if name == "manifest.json":
                    data = data.replace(*MANIFESTS.get(what, (b"", b"")))
                new.writestr(name, data)
    elif what == "foreign":
        bad.write_text("[tool.1]\n")
    other = tmp_path / "other"
    monkeypatch.setenv("TURNDESK_HOME", str(other))
    told = turndesk("setup", "load", bad)
    assert (told.status, told.code, told.err.count("\n")) == (2, code, 1)
    assert str(bad) in told.err
    assert not other.exists()


def _spoil(saved: Path, bad: Path, *, half: bool) -> None:
    """What is packed, in its middle; or how it is said to be packed: by a method that there is not."""
    data = bytearray(saved.read_bytes())
    with zipfile.ZipFile(saved) as old:
        store = old.getinfo("store.db")
    start = store.header_offset + 30 + len("store.db")
    if half:
        data[start : start + 40] = b"\xff" * 40
    else:
        for place in (store.header_offset + 8, data.rindex(b"store.db") - 46 + 10):
            data[place] = 77
    bad.write_bytes(data)


def test_a_program_of_three_gigabytes_is_left_out(saved: Path, turndesk: Turndesk, home: Path) -> None:
    with (home / "programs" / "huge.nc").open("wb") as file:
        file.truncate(3_000_000_000)
    told = turndesk("setup", "save", saved.with_name("b.setup"))
    assert told.status == 0
    assert "programs/huge.nc" in told.out


def test_invalid_machine_file_prevents_saving_a_setup(turndesk: Turndesk, tmp_path: Path) -> None:
    turndesk("offsets", "set", "T3", "x=1", "z=2")
    bad = tmp_path / "bad.toml"
    bad.write_text("[axes]\n")
    assert turndesk("setup", "save", tmp_path / "a.setup", "--machine", bad).status == 2
    assert not (tmp_path / "a.setup").exists()


def test_failed_setup_save_leaves_no_partial_file(
    saved: Path, turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_source: Path, target: Path) -> None:
        target.write_bytes(b"P")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("app.compose.machine.setup_file.shutil.copyfile", full)
    before = sorted(tmp_path.iterdir())
    told = turndesk("setup", "save", tmp_path / "b.setup")
    assert (told.status, told.code) == (2, "cannot-write")
    assert "b.setup" in told.err
    assert os.strerror(errno.ENOSPC) in told.err
    assert sorted(tmp_path.iterdir()) == before
    assert saved in before


@pytest.mark.parametrize("full", ["part.nc", "mine.toml", "turndesk.db"])
def test_full_disk_during_setup_load_leaves_the_home_unchanged(
    full: str, saved: Path, turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = tmp_path / "other"
    monkeypatch.setenv("TURNDESK_HOME", str(other))
    assert turndesk("offsets", "set", "T9", "x=1", "z=2").status == 0
    (other / "programs").mkdir(parents=True)
    (other / "programs" / "part.nc").write_text("(MINE)\n")
    before = {path.name for path in other.rglob("*") if not path.name.startswith("turndesk")}
    real = os.fsync

    def fsync(file: int) -> None:
        if full in os.readlink(f"/proc/self/fd/{file}"):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), full)
        real(file)

    monkeypatch.setattr("os.fsync", fsync)
    told = turndesk("setup", "load", saved)
    assert (told.status, told.err.count("\n")) == (2, 1)
    assert full in told.err
    assert (other / "programs" / "part.nc").read_text() == "(MINE)\n"
    assert "T9" in turndesk("offsets", "show").out
    after = {path.name for path in other.rglob("*") if not path.name.startswith("turndesk")}
    assert after - before <= {"machines"}


def test_files_dated_1970_are_included_in_a_setup(saved: Path, turndesk: Turndesk, home: Path) -> None:
    os.utime(home / "programs" / "part.nc", (0, 0))
    assert turndesk("setup", "save", saved).status == 0
    assert "is undamaged" in turndesk("setup", "load", saved, "--check").out


def test_setup_save_replaces_only_a_setup_file(saved: Path, turndesk: Turndesk, tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text("M30\n")
    told = turndesk("setup", "save", tmp_path / "part.nc")
    assert (told.status, told.code) == (2, "not-replaced")
    assert (tmp_path / "part.nc").read_text() == "M30\n"
    assert turndesk("setup", "save", saved, "--machine", "gt75").status == 2
    assert turndesk("setup", "save", saved).status == 0


def test_missing_setup_file_is_reported(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("setup", "load", tmp_path / "none.setup")
    assert (told.status, told.code, told.err.count("\n")) == (2, "unreadable", 1)
    assert str(tmp_path / "none.setup") in told.err


def test_setup_save_without_a_store_is_rejected(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("setup", "save", tmp_path / "a.setup")
    assert (told.status, told.code) == (2, "no-store")


def test_desktop_entry_is_written_and_removed(
    turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    assert turndesk("setup", "desktop", "--autostart").status == 0
    entry = (tmp_path / "data" / "applications" / "turndesk.desktop").read_text()
    start = (tmp_path / "config" / "autostart" / "turndesk.desktop").read_text()
    assert "--kiosk" not in entry
    assert "turndesk %f\n" in entry
    assert "--kiosk" in start
    types = (tmp_path / "data" / "mime" / "packages" / "turndesk.xml").read_text()
    assert [name in types for name in re.findall(r"application/[a-z-]+", entry)] == [True] * 3
    assert (tmp_path / "data" / "icons" / "hicolor" / "scalable" / "apps" / "turndesk.svg").exists()
    assert turndesk("setup", "desktop", "--remove").out.count("removed") == 4
    assert "no entry" in turndesk("setup", "desktop", "--remove").out
    assert turndesk("setup", "desktop", "--remove", "--autostart").status == 2


@pytest.mark.parametrize(
    "error", [subprocess.TimeoutExpired("update-mime-database", 60), PermissionError(13, "Permission denied")]
)
def test_desktop_entry_is_written_and_removed_although_a_database_tool_fails(
    turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    tried: list[str] = []

    def fail(command: list[str], **_options: object) -> NoReturn:
        tried.append(command[0])
        raise error

    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    monkeypatch.setattr(subprocess, "run", fail)
    monkeypatch.setattr(shutil, "which", str)
    assert turndesk("setup", "desktop").status == 0
    assert (tmp_path / "data" / "applications" / "turndesk.desktop").exists()
    assert turndesk("setup", "desktop", "--remove").out.count("removed") == 3
    assert tried == ["update-desktop-database", "update-mime-database"] * 2


def test_completion_is_available_for_every_shell(turndesk: Turndesk) -> None:
    for shell in SHELL_NAMES:
        told = turndesk("setup", "completion", shell).out
        assert "keep-stock" in told
        assert "completion" in told
        assert told.startswith("eval '") is (shell == "zsh")


@pytest.mark.parametrize("shell", ["tcsh", "powershell", "BASH"])
def test_unknown_shell_is_rejected_by_name(shell: str, turndesk: Turndesk) -> None:
    told = turndesk("setup", "completion", shell)
    assert (told.status, told.out, shell in told.err) == (2, "", True)


def test_bash_completes_commands_actions_and_options(turndesk: Turndesk, tmp_path: Path) -> None:
    script = tmp_path / "c.bash"
    script.write_text(turndesk("setup", "completion", "bash").out)

    def completed(*words: str) -> set[str]:
        line = " ".join(f"'{word}'" for word in words)
        typed = f"COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}"
        ask = f"source {script}; {typed}; _shtab_turndesk; echo ${{COMPREPLY[@]}}"
        told = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=True, cwd=tmp_path)
        return set(told.stdout.split())

    assert completed("turndesk", "prov") == {"prove"}
    assert completed("turndesk", "offsets", "cl") == {"clear"}
    assert "--json" in completed("turndesk", "prove", "--")
    assert completed("turndesk", "offsets", "set", "--w") == {"--why"}
    assert completed("turndesk", "setup", "completion", "") == {"bash", "zsh", "fish"}
    assert completed("turndesk", "prove", "--dialect", "") == {"omniturn", "klartext", "sinumerik"}
    assert completed("turndesk", "prove", "--offsets", "") == {"c.bash"}
    assert completed("turndesk", "--machine", "a.toml", "run", "--headl") == {"--headless"}


@pytest.mark.parametrize("shell", ["bash", "fish"])
def test_file_name_with_a_blank_completes_as_one_word(shell: str, turndesk: Turndesk, tmp_path: Path) -> None:
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not here")
    script = tmp_path / "script"
    script.write_text(turndesk("setup", "completion", shell).out)
    (tmp_path / "my part.nc").touch()
    typed = (
        "COMP_WORDS=(turndesk prove my); COMP_CWORD=2; _shtab_turndesk; echo ${#COMPREPLY[@]} ${COMPREPLY[@]}"
    )
    ask = f"source {script}; " + ("complete -C 'turndesk prove my'" if shell == "fish" else typed)
    told = subprocess.run([shell, "-c", ask], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert told.stdout.split() == (["1"] if shell == "bash" else []) + ["my", "part.nc"]


def test_desktop_entry_quotes_blanks_and_special_characters_in_path(
    turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    place = tmp_path / 'my $own "50%"'
    place.mkdir()
    (place / "turndesk").touch()
    monkeypatch.setattr("sys.executable", str(place / "python"))
    assert turndesk("setup", "desktop").status == 0
    entry = (tmp_path / "data" / "applications" / "turndesk.desktop").read_text()
    assert f'Exec="{tmp_path}/my \\\\$own \\\\"50%%\\\\"/turndesk" %f\n' in entry


# --- hostile archives -----------------------------------------------------------------------------------


def _with(saved: Path, bad: Path, more: Mapping[str, bytes]) -> Path:
    """The saved setup with more members, each with its good SHA-256."""
    with zipfile.ZipFile(saved) as old, zipfile.ZipFile(bad, "w", zipfile.ZIP_DEFLATED) as new:
        told = json.loads(old.read("manifest.json"))
        told["sha256"] |= {name: hashlib.sha256(data).hexdigest() for name, data in more.items()}
        new.writestr("manifest.json", json.dumps(told))
        for name in old.namelist():
            if name not in {"manifest.json", *more}:
                new.writestr(name, old.read(name))
        for name, data in more.items():
            new.writestr(name, data)
    return bad


@pytest.mark.parametrize(
    ("name", "data", "code"),
    [
        ("machine/a/b/c.toml", b"[axes]\n", "too-deep"),
        ("machine/b.toml", b"[axes]\n", "foreign-member"),
        ("machine/mine.xml", b"<a>", "damaged-member"),
        ("machine/mine.hal", b"\xff\x00", "damaged-member"),
        ("programs/a/b/c/d/e/f/g/h.nc", b"G90\n", "too-deep"),
        ("programs/a.nc", b"\x7fELF\0\0", "file-binary"),
        ("programs/a.dxf", b"\0", "file-binary"),
        ("programs/a:b.nc", b"G90\n", "invalid-name"),
        ("programs//a.nc", b"G90\n", "foreign-member"),
        ("programs", b"G90\n", "foreign-member"),
        ("start.sh", b"G90\n", "foreign-member"),
    ],
)
def test_every_file_of_a_setup_is_validated_before_any_is_written(
    name: str, data: bytes, code: str, saved: Path, turndesk: Turndesk, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    bad = _with(saved, tmp_path / "bad.setup", {name: data})
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "other"))
    told = turndesk("setup", "load", bad)
    assert (told.status, told.code) == (2, code)
    assert not (tmp_path / "other").exists()


def test_archive_member_not_in_the_manifest_is_rejected(
    saved: Path, turndesk: Turndesk, tmp_path: Path
) -> None:
    with zipfile.ZipFile(saved, "a") as file:
        file.writestr("programs/more.nc", "G90\n")
    told = turndesk("setup", "load", saved, "--check")
    assert (told.status, told.code) == (2, "foreign-member")


@pytest.mark.parametrize("name", ["manifest.json", "store.db", "programs/part.nc", "machine/mine.toml"])
def test_archive_member_that_unpacks_beyond_its_limit_is_rejected(
    name: str, saved: Path, turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    most = dict(setup_archive.MAX_BYTES_BY_KIND) | {name.partition("/")[0]: 3}
    monkeypatch.setattr(setup_archive, "MAX_BYTES_BY_KIND", most)
    told = turndesk("setup", "load", saved, "--check")
    assert (told.status, told.code) == (2, "member-too-large")


def test_total_size_of_archive_members_is_limited(
    saved: Path, turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(setup_archive, "MAX_TOTAL_BYTES", 1000)
    told = turndesk("setup", "load", saved, "--check")
    assert (told.status, told.code) == (2, "member-too-large")


def test_a_manifest_of_gigabytes_is_not_unpacked(saved: Path, turndesk: Turndesk, tmp_path: Path) -> None:
    """Packed it has under a megabyte; the process may have 256 MB more than it has now."""
    bad = tmp_path / "bad.setup"
    with zipfile.ZipFile(bad, "w", zipfile.ZIP_DEFLATED) as file, file.open("manifest.json", "w") as member:
        for _ in range(320):
            member.write(bytes(1024 * 1024))
    limits = resource.getrlimit(resource.RLIMIT_AS)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + 256 * 1024 * 1024, limits[1]))
    try:
        told = turndesk("setup", "load", bad, "--check")
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)
    assert (told.status, told.code) == (2, "member-too-large")


def test_archive_with_too_many_members_is_rejected(saved: Path, turndesk: Turndesk, tmp_path: Path) -> None:
    more = {f"programs/{number}": b"" for number in range(setup_archive.MAX_MEMBER_COUNT)}
    told = turndesk("setup", "load", _with(saved, tmp_path / "bad.setup", more), "--check")
    assert (told.status, told.code) == (2, "too-many-members")


def test_files_that_cannot_be_loaded_are_left_out_of_a_setup(
    saved: Path, turndesk: Turndesk, home: Path
) -> None:
    (home / "programs" / "notes.pdf").write_bytes(b"%PDF\0")
    (home / "programs" / "empty.nc").write_bytes(b"")
    (home / "programs" / "part.dxf").write_bytes(b"0\nEOF\n")
    told = turndesk("setup", "save", saved)
    assert told.status == 0
    assert "programs/notes.pdf" in told.out
    assert "programs: 3" in turndesk("setup", "load", saved, "--check").out
