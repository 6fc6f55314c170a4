"""The locked packages are in step with pyproject.toml, whole, and the same in all files."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution

import pytest
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

from resources.setup.lock import (
    EXTRAS_BY_SET,
    PYTHONS,
    SETUP_FOLDER,
    get_locked_file,
    list_build_requirements,
    parse_locked_file,
    read_locked_packages,
    read_project_file,
)

SYSTEMS = (("linux", "Linux"), ("darwin", "Darwin"), ("win32", "Windows"))
LOCK = "run: python -m resources.setup.lock"


def _asked(extras: tuple[str, ...]) -> Iterator[Requirement]:
    """What pyproject.toml asks for with these optional dependencies."""
    optional = read_project_file()["project"]["optional-dependencies"]
    yield from map(Requirement, read_project_file()["project"]["dependencies"] + list_build_requirements())
    for extra in extras:
        for each in map(Requirement, optional[extra]):
            if each.name == "turndesk":
                yield from _asked(tuple(each.extras))
            else:
                yield each


def _needs(name: str) -> set[str]:
    """What an installed package needs on some Python and system that TurnDesk runs on."""
    found = set()
    for each in map(Requirement, distribution(name).requires or ()):
        for python in PYTHONS:
            for platform, system in SYSTEMS:
                place = {
                    "python_version": python,
                    "python_full_version": f"{python}.1",
                    "sys_platform": platform,
                    "platform_system": system,
                    "extra": "",
                }
                if each.marker is None or each.marker.evaluate(place):
                    found.add(str(canonicalize_name(each.name)))
    return found


@pytest.mark.parametrize("name", EXTRAS_BY_SET)
def test_requirements_in_pyproject_are_locked(name: str) -> None:
    locked = read_locked_packages(name)
    for each in _asked(EXTRAS_BY_SET[name]):
        package = locked.get(canonicalize_name(each.name))
        assert package, f"{each} is not in {get_locked_file(name).name}; {LOCK}"
        assert each.specifier.contains(package.version), f"{package.name} {package.version}: {each}; {LOCK}"


@pytest.mark.parametrize("name", ["tests", "desk"])
def test_lock_has_exactly_the_transitive_dependencies(name: str) -> None:
    locked = read_locked_packages(name)
    reached: set[str] = set()
    ahead = {str(canonicalize_name(each.name)) for each in _asked(EXTRAS_BY_SET[name])}
    while ahead:
        reached |= ahead
        ahead = {needed for each in ahead for needed in _needs(each)} - reached
    assert reached == set(locked), f"{reached ^ set(locked)}; {LOCK}"


@pytest.mark.parametrize("name", EXTRAS_BY_SET)
def test_every_package_has_its_hashes(name: str) -> None:
    text = get_locked_file(name).read_text(encoding="utf-8")
    packages = list(parse_locked_file(text))
    assert all(package.hashes for package in packages)
    assert sum(len(package.hashes) for package in packages) == text.count("--hash=")
    assert len(packages) == len(re.findall(r"^\S+==", text, re.MULTILINE))


@pytest.mark.parametrize("name", EXTRAS_BY_SET)
def test_lock_contains_no_download_address(name: str) -> None:
    text = get_locked_file(name).read_text(encoding="utf-8")
    assert "://" not in text
    assert not re.search(r"^--(?!hash)", text, re.MULTILINE)


def test_package_has_same_version_in_every_lock() -> None:
    tests = read_locked_packages("tests")
    for name in EXTRAS_BY_SET:
        for package in read_locked_packages(name).values():
            assert package == tests.get(package.name, package), LOCK


def test_installed_packages_match_lock() -> None:
    for package in read_locked_packages("tests").values():
        if package.name in {Requirement(each).name for each in list_build_requirements()}:
            continue
        try:
            here = distribution(package.name).version
        except PackageNotFoundError:
            assert package.marker, f"{package.name} is locked and not installed: sh tests/run.sh"
        else:
            assert here == package.version, "sh tests/run.sh sets up what is locked"


def test_supported_python_versions_agree_everywhere() -> None:
    """lock.py, pyproject.toml and the set-up's own question say the same."""
    asked = SpecifierSet(read_project_file()["project"]["requires-python"])
    minors = [f"3.{minor}" for minor in range(8, 20)]
    assert tuple(each for each in minors if asked.contains(f"{each}.1")) == PYTHONS
    first, last = (tuple(map(int, each.split("."))) for each in (PYTHONS[0], PYTHONS[-1]))
    assert f"{first} <= sys.version_info[:2] <= {last}" in (SETUP_FOLDER / "environment.sh").read_text(
        encoding="utf-8"
    )
    assert first <= sys.version_info[:2] <= last


def test_damaged_lock_is_not_read_as_complete() -> None:
    text = get_locked_file("desk").read_text(encoding="utf-8")
    spoilt = text.replace("--hash=sha256:", "--hash=md5:", 1)
    assert sum(len(each.hashes) for each in parse_locked_file(spoilt)) < spoilt.count("--hash=")
