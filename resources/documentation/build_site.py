"""Build the documentation site: ``python -m resources.documentation.build_site FOLDER``.

The site has the pages of the repository, with search and a navigation by reader. It needs no web server and
no network: open ``index.html`` in the folder. The script requires MkDocs with the theme Material, which are
in the development extra. A warning, such as a link to a missing heading, is an error.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import PackagePath, files
from importlib.util import find_spec
from pathlib import Path

from resources.documentation.site_pages import convert_lists, list_site_files, make_navigation

PROJECT_FOLDER = Path(__file__).parents[2]
PACKAGE_FOLDER = PROJECT_FOLDER / "resources" / "documents"
"""Folder of the site in the sources from which the wheel and the source distribution are built."""
_SETTINGS = Path(__file__).with_name("mkdocs.yml")
_SCRIPT = Path(__file__).with_name("iframe-worker.js")


class SiteError(Exception):
    """Error that prevents the site from being built; the text states the reason."""


def has_site_tools() -> bool:
    """Return whether MkDocs and its theme are installed."""
    return find_spec("mkdocs") is not None and find_spec("material") is not None


@contextmanager
def build_site_for_packages() -> Iterator[Path]:
    """Build the site in the sources, so that the packages contain it, and delete it after the block.

    Yield the folder of the site. Raises SiteError as ``build_site`` does.
    """
    shutil.rmtree(PACKAGE_FOLDER, ignore_errors=True)  # of a build that was killed
    try:
        build_site(PACKAGE_FOLDER)
        yield PACKAGE_FOLDER
    finally:
        shutil.rmtree(PACKAGE_FOLDER, ignore_errors=True)


def build_site(folder: Path, project_folder: Path = PROJECT_FOLDER) -> None:
    """Build the site of the pages in a project folder, and write it to a new folder.

    Raises SiteError if the folder exists, if MkDocs is not installed, or if MkDocs reports an error or a
    warning.
    """
    if folder.exists():
        raise SiteError(f"{folder} already exists. Specify a new folder.")
    if not has_site_tools():
        raise SiteError("MkDocs is not installed. Run sh tests/run.sh once, or pip install -e .[dev].")
    with tempfile.TemporaryDirectory() as work:
        pages = Path(work) / "pages"
        _write_pages(pages, project_folder)
        settings = {
            "INHERIT": str(_SETTINGS),
            "docs_dir": str(pages),
            "nav": make_navigation(project_folder),
        }
        path = Path(work) / "mkdocs.yml"
        path.write_text(json.dumps(settings), encoding="utf-8")  # JSON is also YAML
        command = [sys.executable, "-m", "mkdocs", "build", "--strict"]  # --quiet would also hide warnings
        command += ["--config-file", str(path), "--site-dir", str(folder.absolute())]
        environment = {**os.environ, "NO_MKDOCS_2_WARNING": "true"}
        done = subprocess.run(command, cwd=work, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        shutil.rmtree(folder, ignore_errors=True)
        raise SiteError((done.stderr or done.stdout).strip())
    for source_map in folder.rglob("*.map"):  # only of use to the developers of the theme
        source_map.unlink()
    _write_theme_license(folder)


def _write_theme_license(folder: Path) -> None:
    """Write the license of the theme next to the theme's files, which are a part of the site."""
    licenses = (path for path in files("mkdocs-material") or () if path.parts[-2:] == ("licenses", "LICENSE"))
    license_path: PackagePath = next(licenses)
    (folder / "assets" / "LICENSE").write_text(license_path.read_text(encoding="utf-8"), encoding="utf-8")


def _write_pages(pages: Path, project_folder: Path) -> None:
    """Copy all pages and pictures to the folder ``pages``, with the Markdown that MkDocs expects."""
    for name in list_site_files(project_folder):
        source, target = project_folder / name, pages / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if name.suffix == ".md":
            target.write_text(convert_lists(source.read_text(encoding="utf-8")), encoding="utf-8")
        else:
            shutil.copyfile(source, target)
    shutil.copy(_SCRIPT, pages)


def main(argv: Sequence[str]) -> int:
    """Build the site and return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m resources.documentation.build_site", description=__doc__)
    parser.add_argument("folder", type=Path, help="new folder for the site")
    try:
        build_site(parser.parse_args(argv).folder)
    except SiteError as error:
        sys.stderr.write(f"No site: {error}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
