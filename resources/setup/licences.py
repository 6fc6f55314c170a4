"""List the licenses of all Python packages: ``python -m resources.setup.licences``.

The script reads the metadata of the installed packages and writes the tables of ``docs/licences.md``. If
the license of a package does not permit distribution with TurnDesk, the script reports the package and
writes nothing.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from typing import NamedTuple

from resources.setup.lock import PROJECT_FOLDER, LockedPackage, read_locked_packages

PAGE_PATH = PROJECT_FOLDER / "docs" / "licences.md"
COMPATIBLE = frozenset(
    {
        *(
            "0BSD",
            "Apache-2.0",
            "BSD-2-Clause",
            "BSD-3-Clause",
            "CC0-1.0",
            "MIT",
            "MIT-CMU",
            "PSF-2.0",
            "ZPL-2.1",
            "Zlib",
        ),
        *("LGPL-3.0-only", "MPL-2.0"),  # of a library that is used as it is and can be exchanged
    }
)
"""SPDX names of licenses under which TurnDesk may use a package and distribute it."""
_NAMES = {
    "Apache 2.0": "Apache-2.0",
    "Apache License, Version 2.0": "Apache-2.0",
    "BSD 2-Clause License": "BSD-2-Clause",
    "MIT License": "MIT",
    "MIT license": "MIT",
    "Mozilla Public License 2.0 (MPL 2.0)": "MPL-2.0",
    "ZPL 2.1": "ZPL-2.1",
}
# What says no more than "BSD" of itself, by the text that it brings.
_BY_TEXT = {
    "colorama": "BSD-3-Clause",
    "ghp-import": "Apache-2.0",
    "mergedeep": "MIT",
    "Jinja2": "BSD-3-Clause",
    "partd": "BSD-3-Clause",
    "pyserial": "BSD-3-Clause",
    "wrapt": "BSD-2-Clause",
    "zict": "BSD-3-Clause",
}
# The locked packages by what they are for: a heading of the page, the set, the set that is listed already.
TABLES = (
    ("On every desk", "desk", None),
    ("Only for `prove --scheduler`", "scheduler", "desk"),
    ("Only for tests", "tests", "desk"),
)
_ROW = re.compile(r"^\| (?P<name>[a-z0-9-]+) \| (?P<version>\d\S*) \| (?P<licence>[^|]+) \|", re.MULTILINE)


class LicenseError(Exception):
    """Error for a package whose license does not permit distribution or is not stated."""


class LicensedPackage(NamedTuple):
    """Package with its version and its license as an SPDX expression."""

    name: str
    version: str
    license_expression: str


def get_license(package: Distribution) -> str:
    """Return the license that a package states, as an SPDX expression.

    Raises LicenseError if the license is missing or not compatible.
    """

    def stated(field: str) -> list[str]:
        return package.metadata.get_all(field) or []

    name = stated("Name")[0]
    if name in _BY_TEXT:
        return _BY_TEXT[name]
    offered = stated("License-Expression") + [each.partition("\n")[0].strip() for each in stated("License")]
    offered += [each.rpartition(" :: ")[2] for each in stated("Classifier") if each.startswith("License ::")]
    said = next((each for each in offered if each), "")
    expression = _NAMES.get(said, said)
    if not is_compatible(expression):
        raise LicenseError(
            f"{name}: {said or 'no licence stated'}: read its text; see COMPATIBLE in {__name__}"
        )
    return expression


def is_compatible(expression: str) -> bool:
    """Return whether the license expression permits distribution with TurnDesk.

    At least one alternative (OR) must consist only of compatible licenses (AND).
    """
    return any(
        all(each.strip() in COMPATIBLE for each in choice.split(" AND "))
        for choice in expression.split(" OR ")
    )


def list_packages_without(name: str, excluded_set: str | None) -> Iterator[LockedPackage]:
    """Return the locked packages of the set ``name`` that are not in the set ``excluded_set``."""
    others = read_locked_packages(excluded_set) if excluded_set else {}
    return (each for each in read_locked_packages(name).values() if each.name not in others)


def parse_page(page: str) -> list[LicensedPackage]:
    """Return the packages that the license page lists."""
    return [LicensedPackage(*found.groups()) for found in _ROW.finditer(page)]


def tables(known_licenses: dict[str, str]) -> str:
    """Return the tables of the page as text.

    ``known_licenses`` contains the licenses of packages that are not installed on this computer.
    """
    lines = []
    for heading, name, without in TABLES:
        lines += [f"## {heading}", "", "| package | version | license |", "|---|---|---|"]
        for package in list_packages_without(name, without):
            try:
                licence = get_license(distribution(package.name))
            except PackageNotFoundError:
                licence = known_licenses[package.name]
            lines.append(f"| {package.name} | {package.version} | {licence} |")
        lines.append("")
    return "\n".join(lines)


def update_page(old_page: str) -> str:
    """Return the page with new tables, which replace everything from the first old table on."""
    known = {row.name: row.license_expression for row in parse_page(old_page)}
    return old_page.partition(f"## {TABLES[0][0]}")[0] + tables(known)


def main() -> int:
    """Write the page and return the exit status."""
    try:
        PAGE_PATH.write_text(update_page(PAGE_PATH.read_text(encoding="utf-8")), encoding="utf-8")
    except LicenseError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    except KeyError as error:
        sys.stderr.write(
            f"{error} is not installed: pip install --require-hashes --no-deps -r its locked file first\n"
        )
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
