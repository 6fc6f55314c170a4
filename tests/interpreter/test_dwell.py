"""G04: a dwell over a minute with a tool in force is questioned; it may be meant in milliseconds."""

from __future__ import annotations

import pytest

from tests.interpreter.programs import body, passed


@pytest.mark.parametrize(
    ("dwell", "expected"),
    [("G04F500", [(4, 4, "dwell-long")]), ("G04F60", []), ("G04F.5", [])],
)
def test_long_dwell_with_tool_causes_warning(dwell: str, expected: list[tuple[int, int, str]]) -> None:
    result = passed(body("T1", dwell))
    assert [each for each in result.warnings if each[2] == "dwell-long"] == expected


def test_long_dwell_without_tool_causes_no_warning() -> None:
    assert passed(body("M03S500", "G04F300", "M05")).warnings == []
