"""Check the locked packages for known vulnerabilities: ``python -m resources.setup.audit``.

The check queries the osv.dev database through ``pip-audit`` (``pipx install pip-audit``). It writes the
result with its date to ``docs/vulnerabilities.md``, even if the database could not be reached. The exit
status is 0 only if every package was checked and no package has a known vulnerability.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from typing import Any, NamedTuple

from resources.setup.lock import (
    EXTRAS_BY_SET,
    INSTALLER_SET,
    PROJECT_FOLDER,
    get_locked_file,
    read_locked_packages,
)

PAGE_PATH = PROJECT_FOLDER / "docs" / "vulnerabilities.md"
_ASK = (
    "--disable-pip",
    "--require-hashes",
    "--vulnerability-service=osv",
    "--format=json",
    "--progress-spinner=off",
)
_LONGEST = 300.0  # s


class AuditResult(NamedTuple):
    """Known vulnerabilities of the packages in one locked file.

    ``unchecked_packages`` are the packages for which the database returned no result.
    """

    name: str
    checked_count: int
    vulnerabilities: Sequence[str] = ()
    unchecked_packages: Sequence[str] = ()


def parse_audit_output(name: str, packages: Sequence[str], output: str) -> AuditResult:
    """Parse the output of pip-audit.

    A package that pip-audit omits or skips counts as unchecked.
    """
    try:
        told: list[dict[str, Any]] = json.loads(output)["dependencies"]
        asked = {each["name"]: each["vulns"] for each in told if "vulns" in each}
        found = [f"{package}: {vuln['id']}" for package, vulns in asked.items() for vuln in vulns]
    except (ValueError, LookupError, TypeError):
        return AuditResult(name, 0, unchecked_packages=packages)
    missing = [package for package in packages if package not in asked]
    return AuditResult(name, len(packages) - len(missing), found, missing)


def audit_locked_file(command: str, name: str) -> AuditResult:
    """Run pip-audit on one locked file, and return the result."""
    packages = sorted(read_locked_packages(name))
    words = [command, *_ASK, "--requirement", str(get_locked_file(name))]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=_LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return AuditResult(name, 0, unchecked_packages=packages)
    return parse_audit_output(name, packages, done.stdout)


def format_page(results: Sequence[AuditResult], day: str) -> str:
    """Return the text of the page that reports the results, including its date."""
    return "\n".join(_lines(results, day)) + "\n"


def _lines(results: Sequence[AuditResult], day: str) -> Iterator[str]:
    yield "# Known vulnerabilities\n"
    yield "Written by `python -m resources.setup.audit`, which asks osv.dev about the locked packages.\n"
    if not any(each.checked_count for each in results):
        yield f"{day}: the list could not be reached; **no package was checked**.\n"
    yield f"| locked file ({day}) | packages checked | not checked | known vulnerabilities |"
    yield "|---|---|---|---|"
    for each in results:
        found = ", ".join(each.vulnerabilities) or ("none" if each.checked_count else "unknown")
        yield (
            f"| `locked-{each.name}.txt` | {each.checked_count} | {len(each.unchecked_packages)} | {found} |"
        )


def main() -> int:
    """Run the check, write the page, and return the exit status."""
    command = shutil.which("pip-audit")
    if command is None:
        sys.stderr.write("pip-audit is not installed; it asks the list: pipx install pip-audit\n")
        return 2
    results = [audit_locked_file(command, name) for name in (*EXTRAS_BY_SET, INSTALLER_SET)]
    PAGE_PATH.write_text(format_page(results, f"{datetime.now(UTC):%Y-%m-%d}"), encoding="utf-8")
    sys.stderr.write(
        "".join(
            f"{each.name}: {', '.join(each.vulnerabilities)}\n" for each in results if each.vulnerabilities
        )
    )
    sys.stderr.write(f"{PAGE_PATH} has the result\n")
    return int(any(each.vulnerabilities or each.unchecked_packages for each in results))


if __name__ == "__main__":
    sys.exit(main())
