"""The options of ``turndesk share``, and the tests that use them."""

_ACTIONS = ("begin", "status", "publish", "compare", "take", "keep")
COVERED = {
    **{
        (f"share {action}", option): "tests/extras/sharing/test_share.py"
        for action in _ACTIONS
        for option in ("--machine", "--json")
    },
    ("share publish", "--claim"): "tests/extras/sharing/test_share.py",
    ("share compare", "--id"): "tests/extras/sharing/test_share.py",
    ("share take", "--id"): "tests/extras/sharing/test_share.py",
    **{
        (f"share {action}", "--as"): "tests/cli/test_access.py"
        for action in ("begin", "publish", "take", "keep")
    },
}
REST: dict[str, list[str]] = {}
