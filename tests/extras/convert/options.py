"""The options of ``turndesk convert``, the tests that use them, and what it needs to change something."""

from __future__ import annotations

_OPTIONS = (
    *("--from", "--to", "--no-point", "--unit", "--x", "--tool-post", "--skip-m", "--no-comments"),
    *("--machine", "--out", "--json"),
)
COVERED = {
    **{("convert", option): "tests/extras/convert/test_convert_command.py" for option in _OPTIONS},
    ("convert", "--as"): "tests/cli/test_access.py",
}
CHANGES = {"convert": ("{file}", "--out", "{folder}/new.nc")}
