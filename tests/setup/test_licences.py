"""Every package has a licence that TurnDesk may be passed on with; the page and the SBOM name them all."""

from __future__ import annotations

from email.message import Message
from hashlib import sha256
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path
from typing import cast

import pytest

from resources.setup.licences import (
    PAGE_PATH,
    LicenseError,
    get_license,
    is_compatible,
    parse_page,
    update_page,
)
from resources.setup.lock import EXTRAS_BY_SET, read_locked_packages
from resources.setup.sbom import build_sbom, build_system_component

MAKE = "run: python -m resources.setup.licences"


def _installed(name: str) -> bool:
    try:
        distribution(name)
    except PackageNotFoundError:
        return False
    return True


@pytest.mark.parametrize("name", ["desk", "tests"])
def test_every_license_is_compatible(name: str) -> None:
    for package in read_locked_packages(name):
        assert is_compatible(get_license(distribution(package)))


@pytest.mark.parametrize(
    ("expression", "may_be"),
    [
        ("GPL-3.0-only", False),
        ("MIT AND GPL-2.0-only", False),
        ("AGPL-3.0-or-later", False),
        ("", False),
        ("GPL-3.0-only OR LGPL-3.0-only", True),
        ("MIT AND Zlib", True),
    ],
)
def test_license_expressions_are_classified_as_compatible_or_not(expression: str, may_be: bool) -> None:
    assert is_compatible(expression) is may_be


class Stated:
    """A package that states what it is given."""

    def __init__(self, **fields: str) -> None:
        self.metadata = Message()
        for name, value in ({"Name": "tiny"} | fields).items():
            self.metadata[name.replace("_", "-")] = value


@pytest.mark.parametrize(
    "stated", [{}, {"License": "BSD"}, {"License_Expression": "GPL-3.0-only"}, {"License": "Proprietary"}]
)
def test_a_package_that_may_not_be_passed_on_is_named(stated: dict[str, str]) -> None:
    with pytest.raises(LicenseError, match=r"^tiny: "):
        get_license(cast(Distribution, Stated(**stated)))


def test_license_page_is_up_to_date() -> None:
    text = PAGE_PATH.read_text(encoding="utf-8")
    listed = {(row.name, row.version) for row in parse_page(text)}
    assert listed == {
        (each.name, each.version) for name in EXTRAS_BY_SET for each in read_locked_packages(name).values()
    }, MAKE
    for row in parse_page(text):
        if _installed(row.name):
            assert row.license_expression == get_license(distribution(row.name)), MAKE
    assert update_page(text) == text, MAKE


@pytest.fixture
def document(tmp_path: Path) -> dict[str, object]:
    """The SBOM of a bundle with one wheel and one package of the system."""
    wheel = tmp_path / "pyserial-3.5-py2.py3-none-any.whl"
    wheel.write_bytes(b"abc")
    package = tmp_path / "libegl1_1.7.0-1_amd64.deb"
    package.write_bytes(b"")
    return build_sbom("0.1.0", [wheel], [build_system_component("libegl1", "1.7.0-1", package, "debian")])


def test_sbom_names_every_package_with_license_and_version(
    document: dict[str, list[dict[str, object]]],
) -> None:
    components = {each["bom-ref"]: each for each in document["components"]}
    for package in read_locked_packages("desk").values():
        assert components[package.name]["version"] == package.version
        assert components[package.name]["purl"] == f"pkg:pypi/{package.name}@{package.version}"
        assert components[package.name]["licenses"] == [
            {"expression": get_license(distribution(package.name))}
        ]
    assert set(components) == {*read_locked_packages("desk"), "b612", "deb:libegl1"}
    known = {"turndesk", *components}
    assert {each["ref"] for each in document["dependencies"]} <= known
    for each in document["dependencies"]:
        assert set(cast(list[str], each["dependsOn"])) <= known


def test_the_sbom_has_the_hash_of_every_file(document: dict[str, list[dict[str, object]]]) -> None:
    components = {each["bom-ref"]: each for each in document["components"]}
    # FIPS 180-2, appendix B.1: the SHA-256 of "abc".
    abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert components["pyserial"]["components"] == [
        {
            "type": "file",
            "name": "pyserial-3.5-py2.py3-none-any.whl",
            "hashes": [{"alg": "SHA-256", "content": abc}],
        }
    ]
    assert components["deb:libegl1"]["hashes"] == [{"alg": "SHA-256", "content": sha256(b"").hexdigest()}]


def test_sbom_lists_dependencies_of_each_package(document: dict[str, list[dict[str, object]]]) -> None:
    needs = {each["ref"]: each["dependsOn"] for each in document["dependencies"]}
    assert needs["pyside6-essentials"] == ["shiboken6"]
    assert needs["numpy"] == []
