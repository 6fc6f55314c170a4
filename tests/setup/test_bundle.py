"""The bundle for a computer without a network: it unpacks whole, on the right machine, or says why not."""

from __future__ import annotations

import os
import platform
import subprocess
from pathlib import Path

import pytest

from resources.setup import bundle
from resources.setup.lock import SETUP_FOLDER

pytestmark = pytest.mark.skipif(platform.system() != "Linux", reason="the bundle is for Linux")
MACHINE = platform.machine()


@pytest.fixture
def packed(tmp_path: Path) -> Path:
    """A bundle whose set-up only tells what it was given."""
    folder = tmp_path / "gathered"
    (folder / "wheels").mkdir(parents=True)
    (folder / "wheels" / "tiny.whl").write_bytes(bytes(range(256)) * 500)
    (folder / "VERSION").write_text("1.2", encoding="utf-8")
    told = 'here=$(dirname "$0"); echo "$BUNDLE: $*: $(wc -c <"$here/wheels/tiny.whl")"\n'
    (folder / "install.sh").write_text(told, encoding="utf-8")
    target = tmp_path / "turndesk.run"
    bundle.write_bundle_file(folder, target, MACHINE)
    return target


def run(path: Path, *words: object, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["/bin/sh", str(path), *map(str, words)],
        env={"PATH": os.environ["PATH"], "LC_ALL": "C"} | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_bundle_unpacks_runs_setup_and_removes_its_files(packed: Path, tmp_path: Path) -> None:
    room = tmp_path / "room"
    room.mkdir()
    told = run(packed, "--headless", "/opt/x", TMPDIR=str(room))
    assert told.returncode == 0, told.stderr
    assert told.stdout == f"{packed}: --headless /opt/x: 128000\n"
    assert list(room.iterdir()) == []


def test_bundle_returns_exit_status_of_setup(tmp_path: Path) -> None:
    (tmp_path / "gathered").mkdir()
    (tmp_path / "gathered" / "VERSION").write_text("1.2", encoding="utf-8")
    (tmp_path / "gathered" / "install.sh").write_text("exit 2\n", encoding="utf-8")
    bundle.write_bundle_file(tmp_path / "gathered", tmp_path / "turndesk.run", MACHINE)
    assert run(tmp_path / "turndesk.run").returncode == 2


def test_bundle_only_unpacks_with_unpack_option(packed: Path, tmp_path: Path) -> None:
    assert run(packed, "--unpack", tmp_path / "nowhere").returncode == 2
    (tmp_path / "there").mkdir()
    assert run(packed, "--unpack", tmp_path / "there").returncode == 0
    assert (tmp_path / "there" / "VERSION").read_text(encoding="utf-8") == "1.2"


@pytest.mark.parametrize("spoilt", ["cut short", "a bit turned over", "something behind it"])
def test_a_damaged_bundle_is_not_unpacked(packed: Path, spoilt: str) -> None:
    data = bytearray(packed.read_bytes())
    if spoilt == "cut short":
        del data[-1:]
    elif spoilt == "something behind it":
        data += b"\0"
    else:
        data[-60_000] ^= 1
    packed.write_bytes(data)
    told = run(packed)
    assert told.returncode == 2
    assert told.stderr == (
        f"{packed} is damaged, or was not copied to its end: copy it again from where it was made.\n"
    )
    assert told.stdout == ""


def test_bundle_for_other_architecture_is_rejected(packed: Path, tmp_path: Path) -> None:
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "uname").write_text("#!/bin/sh\necho riscv64\n", encoding="utf-8")
    (tmp_path / "bin" / "uname").chmod(0o755)
    told = run(packed, PATH=f"{tmp_path / 'bin'}:{os.environ['PATH']}")
    assert told.returncode == 2
    assert f"is for {MACHINE}, and this computer is riscv64" in told.stderr


def test_platform_options_list_every_glibc_up_to_that_of_qt() -> None:
    asked = list(bundle.list_platform_options("aarch64"))
    assert asked[0] == "--platform=manylinux_2_39_aarch64"
    assert "--platform=manylinux_2_17_aarch64" in asked
    assert asked[-1] == "--platform=manylinux1_aarch64"


@pytest.fixture
def unpacked(tmp_path: Path) -> Path:
    """What install.sh needs before it looks at any wheel."""
    for name in ("environment.sh", "install.sh"):
        (tmp_path / name).write_text((SETUP_FOLDER / name).read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "VERSION").write_text("1.2", encoding="utf-8")
    return tmp_path / "install.sh"


def test_unwritable_folder_is_reported(unpacked: Path) -> None:
    told = run(unpacked, unpacked / "below-a-file", BUNDLE="turndesk.run")
    assert told.returncode == 2
    assert "may not write to" in told.stderr
    assert "name another folder behind turndesk.run" in told.stderr


def test_unknown_option_shows_usage(unpacked: Path) -> None:
    told = run(unpacked, "--help", BUNDLE="turndesk.run")
    assert told.returncode == 2
    assert told.stderr == "Usage: sh turndesk.run [--headless] [FOLDER]\n"


def test_failed_bundle_build_is_reported_in_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(*_: object) -> None:
        raise bundle.BundleError("pip download …:\nno network")

    monkeypatch.setattr(bundle, "fetch_wheels", refuse)
    monkeypatch.setattr(bundle, "get_bundle_version", lambda: "1.2")
    assert bundle.main([str(tmp_path), f"--machine={MACHINE}"]) == 1
    assert capsys.readouterr().err == "No bundle: pip download …:\nno network\n"
    assert list(tmp_path.iterdir()) == []
