"""The wheel has one package, the same bytes each time, and a command that finds the packages inside."""

from __future__ import annotations

import base64
import hashlib
import io
import subprocess
import sys
import tomllib
import zipfile
from importlib import import_module
from pathlib import Path

import pytest

from core.process_environment import make_module_environment
from resources.setup import wheel_merge
from resources.setup.lock import PROJECT_FOLDER
from resources.setup.wheel_merge import PACKAGES, get_new_path, merge_packages

INFO = "turndesk-1.2.dist-info/"
FILES = {
    "core/x.py": "X = 1\n",
    "app/__init__.py": "",
    f"{INFO}METADATA": "Name: turndesk\n",
    f"{INFO}RECORD": "old",
}

ROOT = Path(__file__).parents[2]


def wheel(files: dict[str, str]) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return made.getvalue()


def names(data: bytes) -> list[str]:
    return zipfile.ZipFile(io.BytesIO(data)).namelist()


def test_packages_are_merged_into_one(monkeypatch: pytest.MonkeyPatch) -> None:
    made = merge_packages(wheel(FILES))
    assert {name.partition("/")[0] for name in names(made)} == {"turndesk", INFO[:-1]}
    assert {"turndesk/core/x.py", "turndesk/app/__init__.py", "turndesk/__main__.py"} <= set(names(made))
    assert names(made)[-1] == f"{INFO}RECORD"


def test_the_record_has_the_hash_of_every_file() -> None:
    with zipfile.ZipFile(io.BytesIO(merge_packages(wheel(FILES)))) as archive:
        rows = [line.split(",") for line in archive.read(f"{INFO}RECORD").decode().splitlines()]
        assert {row[0] for row in rows} == set(archive.namelist())
        for name, digest, size in rows[:-1]:
            data = archive.read(name)
            wanted = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            assert (digest, int(size)) == (f"sha256={wanted}", len(data))
    assert rows[-1] == [f"{INFO}RECORD", "", ""]


def test_file_order_does_not_change_wheel_but_stated_time_does(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    backwards = dict(reversed(FILES.items()))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000000")
    made = merge_packages(wheel(FILES))
    assert merge_packages(wheel(backwards)) == made
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000100")
    assert merge_packages(wheel(FILES)) != made
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    with zipfile.ZipFile(io.BytesIO(merge_packages(wheel(FILES)))) as archive:
        assert {each.date_time[0] for each in archive.infolist()} == {1980}


@pytest.mark.parametrize(
    "name", ["tests/x.py", "setup.py", "turndesk/x.py", "apps/x.py", "x-1.data/scripts/x"]
)
def test_a_file_of_another_package_is_rejected(name: str) -> None:
    with pytest.raises(ValueError, match="no package"):
        get_new_path(name)
    with pytest.raises(ValueError, match="no package"):
        merge_packages(wheel(FILES | {name: ""}))


def test_a_wheel_without_a_record_is_rejected() -> None:
    with pytest.raises(StopIteration):
        merge_packages(wheel({"app/x.py": ""}))


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """An installed turndesk whose command prints where its packages are, and another program's app."""
    main = "from app.cli import other\ndef run_console() -> int:\n    print(other.__file__)\n    return 3\n"
    files = FILES | {"app/cli/__init__.py": "", "app/cli/main.py": main, "app/cli/other.py": ""}
    with zipfile.ZipFile(io.BytesIO(merge_packages(wheel(files)))) as archive:
        archive.extractall(tmp_path)
    (tmp_path / "app").mkdir()
    (tmp_path / "app" / "__init__.py").write_text("NAME = 'another program'\n")
    return tmp_path


@pytest.mark.parametrize(
    "start", [("-m", "turndesk"), ("-c", "import sys, turndesk; sys.exit(turndesk.console())")]
)
def test_installed_command_imports_its_own_packages(installed: Path, start: tuple[str, str]) -> None:
    done = subprocess.run(
        [sys.executable, "-S", *start], cwd=installed, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout.strip()) == (3, str(installed / "turndesk/app/cli/other.py")), (
        done.stderr
    )


def test_another_program_does_not_import_turndesk_packages(installed: Path) -> None:
    code = "import turndesk, app; print(app.NAME); import core"
    done = subprocess.run(
        [sys.executable, "-S", "-c", code], cwd=installed, capture_output=True, text=True, check=False
    )
    assert done.stdout == "another program\n"
    assert "No module named 'core'" in done.stderr


def test_every_turndesk_process_gets_its_module_environment() -> None:
    """A file that starts ``python -m`` of a module of TurnDesk gives it the environment for that."""
    starting = {
        str(path.relative_to(PROJECT_FOLDER))
        for package in ("app", "core", "drivers")
        for path in (PROJECT_FOLDER / package).rglob("*.py")
        if "sys.executable" in (text := path.read_text(encoding="utf-8")) and '"-m"' in text
    }
    without = [
        name
        for name in starting
        if "module_environment(" not in (PROJECT_FOLDER / name).read_text(encoding="utf-8")
    ]
    assert len(starting) >= 4
    assert without == []


def test_module_environment_lists_package_folder_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", "/elsewhere")
    assert make_module_environment(X="1")["PYTHONPATH"].split(":")[0] == str(PROJECT_FOLDER)
    assert make_module_environment(X="1")["PYTHONPATH"].split(":")[1:] == ["/elsewhere"]
    assert make_module_environment(X="1")["X"] == "1"
    monkeypatch.delenv("PYTHONPATH")
    assert make_module_environment()["PYTHONPATH"] == str(PROJECT_FOLDER)


def test_merged_packages_are_those_of_the_source_tree() -> None:
    assert [name for name in PACKAGES if not (PROJECT_FOLDER / name / "__init__.py").is_file()] == []
    assert wheel_merge._LAUNCHER.is_file()


def test_command_of_an_editable_installation_exists() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    module, _, function = project["scripts"]["turndesk"].partition(":")
    assert callable(getattr(import_module(module), function))


def test_the_guide_is_a_part_of_the_wheel() -> None:
    guide = wheel_merge.read_guide_files(PROJECT_FOLDER)
    names = ("guide/screen.md", "guide/es/screen.md", "guide/es/special-functions.md", "pictures/es/jog.png")
    assert {f"resources/guide/{name}" for name in names} <= guide.keys()
    made = zipfile.ZipFile(io.BytesIO(merge_packages(wheel(FILES), guide)))
    text = (PROJECT_FOLDER / "docs" / "guide" / "screen.md").read_bytes()
    assert made.read("turndesk/resources/guide/guide/screen.md") == text


def test_a_wheel_without_the_guide_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        wheel_merge.read_guide_files(tmp_path)


def test_a_built_documentation_site_is_a_part_of_the_wheel(tmp_path: Path) -> None:
    (tmp_path / "resources/documents/docs").mkdir(parents=True)
    (tmp_path / "resources/documents/docs/a.html").write_bytes(b"page")
    site = wheel_merge.read_site_files(tmp_path)
    made = zipfile.ZipFile(io.BytesIO(merge_packages(wheel(FILES), site)))
    assert made.read("turndesk/resources/documents/docs/a.html") == b"page"


def test_a_wheel_from_a_clone_has_no_documentation_site() -> None:
    assert wheel_merge.read_site_files(PROJECT_FOLDER) == {}
