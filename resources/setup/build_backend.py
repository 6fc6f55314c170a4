"""Build backend of the TurnDesk wheel, which has all source packages in one package ``turndesk``.

Setuptools builds the wheel, and this backend then moves its packages, and adds the user's guide and the
documentation site. Wheels and source distributions get a description for the page of a package index.
Setuptools alone builds editable installs; these and the source distributions have the package names of the
repository.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from setuptools import build_meta
from setuptools.build_meta import (
    build_editable,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
)

from resources.setup.index_page import convert_description
from resources.setup.packages.reproducible_archives import repack_tar_gz
from resources.setup.wheel_merge import merge_packages, read_guide_files, read_site_files

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
]


def build_wheel(
    wheel_directory: str,
    config_settings: Mapping[str, Any] | None = None,
    metadata_directory: str | None = None,
) -> str:
    """Build the wheel in a folder, and return the file name of the wheel."""
    settings = dict(config_settings) if config_settings else None
    name = str(build_meta.build_wheel(wheel_directory, settings, metadata_directory))
    path = Path(wheel_directory) / name
    added = read_guide_files(Path.cwd()) | read_site_files(Path.cwd())
    path.write_bytes(merge_packages(path.read_bytes(), added))
    return name


def build_sdist(sdist_directory: str, config_settings: Mapping[str, Any] | None = None) -> str:
    """Build the source distribution in a folder, and return its file name.

    Its bytes do not depend on the time and the order of the files.
    """
    name = str(build_meta.build_sdist(sdist_directory, dict(config_settings) if config_settings else None))
    repack_tar_gz(Path(sdist_directory) / name, _convert_metadata)
    return name


def _convert_metadata(name: str, content: bytes) -> bytes:
    return convert_description(content) if name.endswith("/PKG-INFO") else content
