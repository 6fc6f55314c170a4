"""The options of ``turndesk shapes``, the tests that use them, and what it needs to change something."""

from __future__ import annotations

COVERED = {
    **{
        ("shapes", option): "tests/extras/shapes/test_shapes_command.py"
        for option in ("--list", "--out", "--tools", "--machine", "--json")
    },
    ("shapes", "--as"): "tests/cli/test_access.py",
}
CHANGES = {"shapes": ("{file}", "--out", "{folder}/new.nc")}
