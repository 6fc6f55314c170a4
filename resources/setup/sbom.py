"""SBOM of TurnDesk in CycloneDX 1.6 JSON.

The SBOM lists all packages and files with their licenses, hashes and dependencies.
"""

from __future__ import annotations

import hashlib
import os
import uuid
from collections.abc import Iterable
from datetime import UTC, datetime
from importlib.metadata import distribution
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name, parse_wheel_filename

from resources.setup.licences import get_license
from resources.setup.lock import PYTHONS, read_locked_packages, read_project_file

Component = dict[str, Any]
_ROOT = "turndesk"


def build_sbom(
    version: str, wheels: Iterable[Path], system_components: Iterable[Component] = ()
) -> dict[str, Any]:
    """Return the SBOM for a version of TurnDesk, its wheels and the bundled system components.

    Raises LicenseError if the license of a package does not permit distribution.
    """
    files = _files(wheels)
    names = sorted(read_locked_packages("desk"))
    packages = [_package(name, files.get(name, [])) for name in names]
    others = [*_brought_along(), *system_components]
    needs = {name: sorted(_needs(name) & set(names)) for name in names}
    asked = {
        str(canonicalize_name(Requirement(each).name))
        for each in read_project_file()["project"]["dependencies"]
    }
    product = {"type": "application", "bom-ref": _ROOT, "name": _ROOT, "version": version}
    product["purl"] = f"pkg:generic/{_ROOT}@{version}"
    depends = [{"ref": _ROOT, "dependsOn": sorted(asked | {each["bom-ref"] for each in others})}]
    depends += [{"ref": name, "dependsOn": needed} for name, needed in needs.items()]
    document: dict[str, Any] = {"bomFormat": "CycloneDX", "specVersion": "1.6", "version": 1}
    document["serialNumber"] = f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, f'{_ROOT}@{version}')}"
    document["metadata"] = {
        "timestamp": _now().isoformat(timespec="seconds"),
        "component": product | {"licenses": [{"license": {"id": "MIT"}}]},
    }
    document["components"] = packages + others
    document["dependencies"] = depends
    return document


def build_system_component(name: str, version: str, path: Path, distribution_name: str) -> Component:
    """Return the component for a system package that is part of the bundle.

    ``distribution_name`` is "debian" or "ubuntu".
    """
    return {
        "type": "library",
        "bom-ref": f"deb:{name}",
        "name": name,
        "version": version,
        "purl": f"pkg:deb/{distribution_name}/{name}@{version}",
        "hashes": [_sha256(path)],
    }


def _package(name: str, files: list[Path]) -> Component:
    """Return the component for a locked package, including its license and the available files."""
    locked = read_locked_packages("desk")[name]
    component: Component = {"type": "library", "bom-ref": name, "name": name, "version": locked.version}
    component["purl"] = f"pkg:pypi/{name}@{locked.version}"
    component["licenses"] = [{"expression": get_license(distribution(name))}]
    if inside := [*_qt(name, locked.version), *map(_file, files)]:
        component["components"] = inside
    return component


def _qt(name: str, version: str) -> list[Component]:
    """Return a list with the component for Qt if the package ``name`` contains Qt, otherwise [].

    Qt has the same version as this package. The CPE of the component identifies known vulnerabilities of
    Qt.
    """
    if name != "pyside6-essentials":
        return []
    cpe = f"cpe:2.3:a:qt:qt:{version}:*:*:*:*:*:*:*"
    return [{"type": "framework", "name": "Qt", "version": version, "cpe": cpe}]


def _brought_along() -> list[Component]:
    """Return the components for third-party files that TurnDesk includes among its own files."""
    font: Component = {"type": "data", "bom-ref": "b612", "name": "B612", "description": "the fonts"}
    return [font | {"licenses": [{"license": {"id": "OFL-1.1"}}]}]


def _needs(name: str) -> set[str]:
    """Return the packages that an installed package requires on Linux.

    The result applies to all Python versions that TurnDesk supports.
    """
    places = [{"python_version": each, "python_full_version": f"{each}.0", "extra": ""} for each in PYTHONS]
    wanted = map(Requirement, distribution(name).requires or ())
    return {
        str(canonicalize_name(each.name))
        for each in wanted
        if each.marker is None or any(each.marker.evaluate(place) for place in places)
    }


def _now() -> datetime:
    """Return the time of a reproducible build (``SOURCE_DATE_EPOCH``) or else the current time."""
    stated = os.environ.get("SOURCE_DATE_EPOCH", "")
    return datetime.fromtimestamp(int(stated), UTC) if stated else datetime.now(UTC)


def _files(wheels: Iterable[Path]) -> dict[str, list[Path]]:
    """Return the wheels of each package, with the package names as keys."""
    found: dict[str, list[Path]] = {}
    for path in sorted(wheels):
        found.setdefault(str(parse_wheel_filename(path.name)[0]), []).append(path)
    return found


def _file(path: Path) -> Component:
    return {"type": "file", "name": path.name, "hashes": [_sha256(path)]}


def _sha256(path: Path) -> dict[str, str]:
    with path.open("rb") as file:
        return {"alg": "SHA-256", "content": hashlib.file_digest(file, "sha256").hexdigest()}
