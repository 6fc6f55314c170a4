"""The options of ``turndesk parts`` and ``turndesk shift``, and the tests that use them."""

_FOLDER = "tests/extras/quality"
COVERED = {
    **{("parts", option): f"{_FOLDER}/test_parts_command.py" for option in ("--csv", "--json")},
    **{
        ("shift", option): f"{_FOLDER}/test_shift_figures.py"
        for option in ("--back", "--from", "--to", "--report", "--json", "--metric")
    },
}
REST: dict[str, list[str]] = {"shift": []}
