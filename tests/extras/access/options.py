"""The options of ``turndesk access``, and the tests that use them."""

_TESTS = "tests/extras/access/test_access_command.py"
COVERED = {
    **{(f"access {action}", "--json"): _TESTS for action in ("list", "table")},
    **{(f"access {action}", "--as"): _TESTS for action in ("add", "pin", "remove")},
    ("access add", "--level"): _TESTS,
}
REST: dict[str, list[str]] = {"access table": [], "access reset": []}
