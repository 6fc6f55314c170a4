"""Release artefacts: the same bytes each time, versions in order, complete templates, and a manual page."""

from __future__ import annotations

import hashlib
import io
import re
import subprocess
import tarfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

from app.cli.actions.desktop_entry import format_desktop_entry
from app.cli.main import list_commands
from resources.setup import release
from resources.setup.bundle import BundleError, copy_wheel_sources, run
from resources.setup.lock import PROJECT_FOLDER, PYTHONS, SETUP_FOLDER
from resources.setup.packages import debian_package, manual_page, reproducible_archives
from resources.setup.packages.debian_package import TARGETS, get_debian_version
from resources.setup.sbom import build_sbom
from resources.setup.wheel_merge import read_guide_files

DEBIAN = SETUP_FOLDER / "debian"
WORDS = {"VERSION", "ARCHITECTURE", "PYTHON", "GLIBC", "SIZE", "FOLDER"}


@pytest.fixture(autouse=True)
def at_a_stated_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1796113800")  # 2026-12-01 08:30 UTC


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "folder"
    (made / "b").mkdir(parents=True)
    (made / "b" / "run").write_text("run")
    (made / "b" / "run").chmod(0o711)
    (made / "a").write_text("a")
    (made / "link").symlink_to("/usr/bin/python3")
    return made


def test_archive_bytes_do_not_depend_on_time_or_owner(folder: Path, tmp_path: Path) -> None:
    reproducible_archives.set_times(folder)
    reproducible_archives.write_tar_gz(folder, tmp_path / "1.tar.gz", "x")
    (folder / "a").touch()
    reproducible_archives.set_times(folder)
    reproducible_archives.write_tar_gz(folder, tmp_path / "2.tar.gz", "x")
    assert (tmp_path / "1.tar.gz").read_bytes() == (tmp_path / "2.tar.gz").read_bytes()
    with tarfile.open(tmp_path / "1.tar.gz") as archive:
        members = {each.name: each for each in archive.getmembers()}
        assert {(each.uid, each.uname, each.mtime) for each in members.values()} == {(0, "root", 1796113800)}
        assert (members["x/b/run"].mode, members["x/a"].mode) == (0o755, 0o644)
        assert members["x/link"].linkname == "/usr/bin/python3"


def test_archive_bytes_depend_on_content(folder: Path, tmp_path: Path) -> None:
    reproducible_archives.write_tar_gz(folder, tmp_path / "1.tar.gz", "x")
    (folder / "a").write_text("b")
    reproducible_archives.write_tar_gz(folder, tmp_path / "2.tar.gz", "x")
    assert (tmp_path / "1.tar.gz").read_bytes() != (tmp_path / "2.tar.gz").read_bytes()


def test_archive_of_other_tool_is_made_reproducible(tmp_path: Path) -> None:
    made = []
    for number, names in enumerate((("a", "b"), ("b", "a"))):
        path = tmp_path / f"{number}.tar.gz"
        with tarfile.open(path, "w:gz") as archive:
            for name in names:
                member = tarfile.TarInfo(f"p/{name}")
                member.size, member.mtime, member.uname = 1, 1000 + number, f"user{number}"
                archive.addfile(member, io.BytesIO(name.encode()))
        reproducible_archives.repack_tar_gz(path, lambda name, content: content + name[-1:].encode())
        made.append(path.read_bytes())
    assert made[0] == made[1]
    with tarfile.open(path) as archive:
        file = archive.extractfile("p/a")
        assert file is not None
        assert file.read() == b"aa"


def test_two_folders_are_compared_by_names_and_bytes(tmp_path: Path) -> None:
    for name, text in (("1/a", "x"), ("2/a", "x"), ("1/b", "x"), ("2/b", "y"), ("2/c", "")):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert release.list_differences(tmp_path / "1", tmp_path / "2") == ["b", "c"]
    assert release.list_differences(tmp_path / "1", tmp_path / "1") == []


def test_checksums_match_the_files(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"abc")
    release.write_checksums(tmp_path)
    release.write_checksums(tmp_path)  # the list itself is not in the list
    assert (tmp_path / release.CHECKSUM_FILE_NAME).read_text() == f"{hashlib.sha256(b'abc').hexdigest()}  a\n"


def test_an_existing_folder_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert release.main([str(tmp_path)]) == 1
    assert "exists already" in capsys.readouterr().err


def test_copied_sources_of_wheel_include_the_guide(tmp_path: Path) -> None:
    copy_wheel_sources(tmp_path / "copy")
    assert read_guide_files(tmp_path / "copy") == read_guide_files(PROJECT_FOLDER)
    assert not list((tmp_path / "copy").rglob("__pycache__"))


def test_failed_build_step_reports_its_error_above_the_notes_of_pip() -> None:
    script = "echo 'ValueError: no guide' >&2; seq 10 >&2; exit 1"
    with pytest.raises(BundleError, match="ValueError: no guide"):
        run("sh", "-c", script)


def test_version_with_commit_sorts_before_its_release() -> None:
    target = TARGETS["debian12"]
    assert get_debian_version("0.1.0", target) == "0.1.0+debian12"
    assert get_debian_version("0.1.0-20261201-1a2b3c4", target) == "0.1.0~202612010830.1a2b3c4+debian12"


def test_a_changed_checkout_has_no_version() -> None:
    with pytest.raises(BundleError):
        get_debian_version("0.1.0-20261201-1a2b3c4-changed", TARGETS["debian12"])


def test_python_versions_of_targets_are_locked() -> None:
    assert {each.python_version for each in TARGETS.values()} <= set(PYTHONS)


@pytest.mark.parametrize("name", ["control", "postinst", "prerm", "postrm"])
def test_every_placeholder_of_template_is_filled(name: str) -> None:
    places = set(re.findall("@([A-Z]+)@", (DEBIAN / name).read_text(encoding="utf-8")))
    assert places <= WORDS


@pytest.mark.parametrize("name", ["postinst", "prerm", "postrm", "kiosk", "turndesk"])
def test_scripts_are_valid_shell_and_exit_on_error(name: str) -> None:
    text = (DEBIAN / name).read_text(encoding="utf-8")
    assert subprocess.run(["/bin/sh", "-n"], input=text, text=True, check=False).returncode == 0
    assert "set -e" in text or "exec " in text
    assert "/home" not in text


def test_kiosk_uses_x11_so_that_stop_keys_act_during_a_stall() -> None:
    unit = (DEBIAN / "turndesk-kiosk@.service").read_text(encoding="utf-8")
    script = (DEBIAN / "kiosk").read_text(encoding="utf-8")
    assert not re.search("wayland|weston", unit + script, re.IGNORECASE)
    assert "ExecStart=/usr/bin/startx /usr/share/turndesk/kiosk -- " in unit
    # The limits of a real-time process remain, and only the account's own X clients can connect.
    assert {"LimitRTPRIO=60", "LimitMEMLOCK=infinity", "Restart=always"} <= set(unit.splitlines())
    assert "-nolisten tcp" in unit


def test_package_suggests_every_program_of_the_kiosk() -> None:
    control = (DEBIAN / "control").read_text(encoding="utf-8")
    (suggested,) = re.findall(r"^Suggests: (.*)$", control, re.MULTILINE)
    assert {"xserver-xorg", "xinit", "openbox", "kbd"} <= set(suggested.split(", "))
    assert "libxi6" in control  # Without it, the key watcher cannot read stop keys.


def test_package_contains_every_file_that_the_kiosk_names() -> None:
    source = Path(debian_package.__file__).read_text(encoding="utf-8")
    texts = [(DEBIAN / name).read_text(encoding="utf-8") for name in ("kiosk", "turndesk-kiosk@.service")]
    named = set(re.findall(r"/(usr/share/turndesk/\S+)", " ".join(texts)))
    assert named == {"usr/share/turndesk/kiosk", "usr/share/turndesk/kiosk-openbox.xml"}
    assert [each for each in named if f'"{each}"' not in source] == []


def test_window_manager_of_kiosk_binds_no_key_and_opens_no_menu() -> None:
    root = ElementTree.parse(DEBIAN / "kiosk-openbox.xml").getroot()
    names = {each.tag.partition("}")[2] for each in root.iter()}
    assert "keyboard" in names  # Without this element, openbox uses its own key bindings.
    assert not names & {"keybind", "menu"}
    assert {each.get("name") for each in root.iter() if each.tag.endswith("}action")} == {"Focus", "Raise"}


def test_package_depends_on_system_libraries_of_setup() -> None:
    control = (DEBIAN / "control").read_text(encoding="utf-8")
    text = (SETUP_FOLDER / "environment.sh").read_text(encoding="utf-8")
    wanted = " ".join(re.findall(r'^(?:QT|WINDOW|WAYLAND)_LIBRARIES="(.*)"$', text, re.MULTILINE)).split()
    assert len(wanted) > 10
    assert [name for name in wanted if name not in control] == []


def test_every_override_of_lintian_has_a_reason() -> None:
    lines = (DEBIAN / "lintian-overrides").read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("#")
    assert [line for line in lines if not line.startswith(("#", "turndesk: "))] == []


def test_the_copyright_names_every_package() -> None:
    text = debian_package._copyright()
    assert {"numpy", "pyside6-essentials", "psycopg"} <= set(re.findall(r"authors of (\S+),", text))
    assert "pytest" not in text


def test_manual_page_has_every_command_and_only_known_macros() -> None:
    page = manual_page.format_manual_page()
    headings = {
        line.removeprefix(".SS turndesk ").split()[0] for line in page.splitlines() if line[:3] == ".SS"
    }
    assert {each.replace("-", r"\-") for each in list_commands()} == headings
    assert page.startswith('.TH TURNDESK 1 "2026-12-01"')
    assert {line.split()[0] for line in page.splitlines() if line.startswith(".")} <= {
        ".TH",
        ".SH",
        ".SS",
        ".TP",
        ".B",
    }


@pytest.mark.parametrize(
    ("text", "expected"), [(".x", r"\&.x"), ("'x", r"\&'x"), ("--a\\b", r"\-\-a\eb"), ("a.b", "a.b")]
)
def test_special_characters_of_the_manual_are_escaped(text: str, expected: str) -> None:
    assert manual_page.escape_text(text) == expected


def test_menu_entry_starts_the_command(tmp_path: Path) -> None:
    assert "Exec=/usr/bin/turndesk %f" in format_desktop_entry("/usr/bin/turndesk %f")


def test_release_sbom_is_reproducible() -> None:
    assert build_sbom("1.2", []) == build_sbom("1.2", [])
    assert build_sbom("1.2", [])["serialNumber"] != build_sbom("1.3", [])["serialNumber"]
    assert build_sbom("1.2", [])["metadata"]["timestamp"] == "2026-12-01T08:30:00+00:00"
