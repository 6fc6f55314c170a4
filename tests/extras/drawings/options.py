"""The options of ``turndesk profile``, the tests that use them, and what it needs to change something."""

from __future__ import annotations

_OPTIONS = (
    *("--list", "--unit", "--layer", "--axis", "--contour", "--front", "--zero", "--shift", "--side"),
    *("--gap", "--metric", "--material", "--bar", "--face", "--hole", "--rough", "--tool", "--groove-tool"),
    *("--comp", "--tools", "--machine", "--out", "--json"),
)
COVERED = {
    **{("profile", option): "tests/extras/drawings/test_profile.py" for option in _OPTIONS},
    ("profile", "--as"): "tests/cli/test_access.py",
}
CHANGES = {"profile": ("{file}", "--out", "{folder}/new.nc")}
