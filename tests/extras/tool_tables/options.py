"""The options of ``turndesk tools``, the tests that use them, and what it needs to change something."""

from __future__ import annotations

_IMPORT = "tests/extras/tool_tables/test_tools_import.py"
_EXPORT = "tests/extras/tool_tables/test_tools_export.py"
_OPTIONS = ("--from", "--map", "--unit", "--x", "--only", "--no-positions", "--replace", "--json", "--yes")
COVERED = {
    **{("tools import", option): _IMPORT for option in (*_OPTIONS, "--machine", "--number", "--why")},
    **{("tools export", option): _EXPORT for option in ("--to", "--map", "--unit", "--only")},
    ("tools import", "--as"): "tests/cli/test_access.py",
}
CHANGES = {"tools import": ("{file}", "--yes")}
READS = {"tools export"}  # to a file of whoever asks; the store stays as it is
