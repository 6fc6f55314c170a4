"""Conversion of a wheel so that all its packages are parts of one package ``turndesk``.

The wheel has the same bytes whenever ``SOURCE_DATE_EPOCH`` and the source are the same.
"""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import os
import time
import zipfile
from collections.abc import Mapping
from pathlib import Path

from resources.setup.index_page import convert_description

PACKAGES = ("app", "core", "drivers", "resources")
PACKAGE_NAME = "turndesk"
GUIDE_FILES = tuple(
    f"{folder}/{page}" for folder in ("guide", "guide/es") for page in ("screen.md", "special-functions.md")
)
"""Files of the guide in ``docs`` that ``app.desk.pages.guide_text`` reads."""
_LAUNCHER = Path(__file__).with_name("launcher.py")
_ENTRY_POINTS = f"[console_scripts]\n{PACKAGE_NAME} = {PACKAGE_NAME}:console\n"
_MAIN = (
    f'import sys\n\nfrom {PACKAGE_NAME} import console\n\nif __name__ == "__main__":\n    '
    f"sys.exit(console())\n"
)
_EARLIEST = 315532800  # s since 1970, the first time that an archive can state
_MODE = 0o100644


def read_guide_files(project_folder: Path) -> dict[str, bytes]:
    """Return the files of the user's guide that the screen shows as help, by their paths in the wheel.

    Raises FileNotFoundError if a file of the guide is missing.
    """
    docs = project_folder / "docs"
    pictures = (*docs.glob("pictures/*.png"), *docs.glob("pictures/es/*.png"))
    paths = (*(docs / name for name in GUIDE_FILES), *pictures)
    return {f"resources/guide/{path.relative_to(docs).as_posix()}": path.read_bytes() for path in paths}


def read_site_files(project_folder: Path) -> dict[str, bytes]:
    """Return the files of the documentation site by their paths, or an empty dict if it was not built."""
    folder = project_folder / "resources" / "documents"
    paths = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(project_folder).as_posix(): path.read_bytes() for path in paths}


def merge_packages(wheel: bytes, added_files: Mapping[str, bytes] | None = None) -> bytes:
    """Return a wheel whose packages are parts of ``turndesk``, with ``added_files`` by their old paths.

    The files are sorted and all have the same time.
    """
    with zipfile.ZipFile(io.BytesIO(wheel)) as archive:
        files = {
            get_new_path(name): archive.read(name) for name in archive.namelist() if not name.endswith("/")
        }
    files |= {get_new_path(name): data for name, data in (added_files or {}).items()}
    info = _find_record(files).removesuffix("RECORD")
    files[f"{info}METADATA"] = convert_description(files[f"{info}METADATA"])
    files[f"{info}entry_points.txt"] = _ENTRY_POINTS.encode()
    files[f"{info}top_level.txt"] = f"{PACKAGE_NAME}\n".encode()
    files[f"{PACKAGE_NAME}/__init__.py"] = _LAUNCHER.read_bytes()
    files[f"{PACKAGE_NAME}/__main__.py"] = _MAIN.encode()
    return write_wheel(files)


def write_wheel(files: Mapping[str, bytes]) -> bytes:
    """Return a wheel with these files, sorted and with one time; its RECORD is calculated again.

    Raises StopIteration if the files do not include a RECORD.
    """
    record = _find_record(files)
    recorded = {name: data for name, data in files.items() if name != record}
    complete = {**recorded, record: _record(recorded, record)}
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(complete, key=lambda each: (each == record, each)):
            entry = zipfile.ZipInfo(name, _time())
            entry.external_attr = _MODE << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, complete[name])
    return made.getvalue()


def _find_record(files: Mapping[str, bytes]) -> str:
    return next(name for name in files if name.endswith(".dist-info/RECORD"))


def get_new_path(name: str) -> str:
    """Return the new path of a file in the wheel.

    Raises ValueError if the file belongs to an unknown package.
    """
    top = name.partition("/")[0]
    if top in PACKAGES:
        return f"{PACKAGE_NAME}/{name}"
    if top.endswith(".dist-info"):
        return name
    raise ValueError(f"{name}: this file belongs to no package of TurnDesk")


def _time() -> tuple[int, int, int, int, int, int]:
    stated = max(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), _EARLIEST)
    at = time.gmtime(stated)
    return at.tm_year, at.tm_mon, at.tm_mday, at.tm_hour, at.tm_min, at.tm_sec


def _record(files: Mapping[str, bytes], record: str) -> bytes:
    """Return the contents of RECORD: the wheel's files with their hashes and sizes."""
    made = io.StringIO()
    rows = csv.writer(made, lineterminator="\n")
    for name in sorted(files):
        digest = base64.urlsafe_b64encode(hashlib.sha256(files[name]).digest()).rstrip(b"=").decode()
        rows.writerow((name, f"sha256={digest}", len(files[name])))
    rows.writerow((record, "", ""))
    return made.getvalue().encode()
