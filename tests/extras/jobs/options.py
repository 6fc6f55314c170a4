"""The options of ``turndesk jobs``, and the tests that use them."""

_TESTS = "tests/extras/jobs/test_jobs_command.py"
COVERED = {
    ("jobs list", "--json"): _TESTS,
    ("jobs add", "--note"): _TESTS,
    ("jobs clear", "--all"): _TESTS,
    **{(f"jobs {action}", "--as"): _TESTS for action in ("add", "move", "remove", "clear")},
}
REST = {"jobs add": ["pin", "2"], "jobs move": ["1", "2"], "jobs remove": ["1"]}
