"""Check of the locked packages for known vulnerabilities: ``python -m resources.setup.audit``.

The check queries the list of osv.dev through ``pip-audit`` (``pipx install pip-audit``). It writes the
result with its date to ``docs/vulnerabilities.md``, even if the list could not be reached. The exit status
is 0 only if every package was checked and no package has a known vulnerability.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from typing import Any, NamedTuple

from resources.setup.lock import HOUSE, INSTALLER, SETS, locked_file, locked_packages

PAGE = HOUSE / "docs" / "vulnerabilities.md"
_ASK = (
    "--disable-pip",
    "--require-hashes",
    "--vulnerability-service=osv",
    "--format=json",
    "--progress-spinner=off",
)
_LONGEST = 300.0  # s


class Result(NamedTuple):
    """Vulnerabilities that the list contains for one locked file.

    ``unchecked`` are the packages for which the list returned no result.
    """

    name: str
    checked: int
    found: Sequence[str] = ()
    unchecked: Sequence[str] = ()


def result_of(name: str, packages: Sequence[str], answer: str) -> Result:
    """Parse the output of pip-audit.

    A package that pip-audit omits or skips is unchecked.
    """
    try:
        told: list[dict[str, Any]] = json.loads(answer)["dependencies"]
        asked = {each["name"]: each["vulns"] for each in told if "vulns" in each}
        found = [f"{package}: {vuln['id']}" for package, vulns in asked.items() for vuln in vulns]
    except (ValueError, LookupError, TypeError):
        return Result(name, 0, unchecked=packages)
    missing = [package for package in packages if package not in asked]
    return Result(name, len(packages) - len(missing), found, missing)


def audited(command: str, name: str) -> Result:
    """Run pip-audit on one locked file, and return the result."""
    packages = sorted(locked_packages(name))
    words = [command, *_ASK, "--requirement", str(locked_file(name))]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=_LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return Result(name, 0, unchecked=packages)
    return result_of(name, packages, done.stdout)


def page(results: Sequence[Result], day: str) -> str:
    """Return the text of the page, including its date."""
    return "\n".join(_lines(results, day)) + "\n"


def _lines(results: Sequence[Result], day: str) -> Iterator[str]:
    yield "# Known vulnerabilities\n"
    yield "Written by `python -m resources.setup.audit`, which asks osv.dev about the locked packages.\n"
    if not any(each.checked for each in results):
        yield f"{day}: the list could not be reached; **no package was checked**.\n"
    yield f"| locked file ({day}) | packages checked | not checked | known vulnerabilities |"
    yield "|---|---|---|---|"
    for each in results:
        found = ", ".join(each.found) or ("none" if each.checked else "unknown")
        yield f"| `locked-{each.name}.txt` | {each.checked} | {len(each.unchecked)} | {found} |"


def main() -> int:
    """Run the check, write the page, and return the exit status."""
    command = shutil.which("pip-audit")
    if command is None:
        sys.stderr.write("pip-audit is not installed; it asks the list: pipx install pip-audit\n")
        return 2
    results = [audited(command, name) for name in (*SETS, INSTALLER)]
    PAGE.write_text(page(results, f"{datetime.now(UTC):%Y-%m-%d}"), encoding="utf-8")
    sys.stderr.write("".join(f"{each.name}: {', '.join(each.found)}\n" for each in results if each.found))
    sys.stderr.write(f"{PAGE} has the result\n")
    return int(any(each.found or each.unchecked for each in results))


if __name__ == "__main__":
    sys.exit(main())
