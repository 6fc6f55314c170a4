"""The command of MTConnect: it has no options, and changes nothing."""

COVERED: dict[tuple[str, str], str] = {}
READS = {"machine mtconnect"}
