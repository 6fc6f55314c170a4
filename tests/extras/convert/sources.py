"""Conversions of short source programs in tests."""

from __future__ import annotations

from typing import Any

from core.extras.convert.conversion import Conversion, convert_program
from core.extras.convert.source_options import ConversionOptions, SourceControl
from core.interpreter.shared.job_setup import ControlLimits

FANUC = "G20G40G99\nT0101\nG97S500M03\nG00X2.Z.1\nG01F.01\n"
"""Beginning of a Fanuc program: the tool is at X2. Z.1, and the feed is .01 in/rev."""
LINUXCNC = "G20G18G7G95\nT1M6\nG97S500M3\nG0X2Z.1\nF.01\n"
"""Beginning of a LinuxCNC program at the same point."""


def converted(text: str, control: str = "fanuc-a", **options: Any) -> Conversion:
    """Return the conversion of a complete program."""
    wanted = ConversionOptions(
        SourceControl(control), writes_comments=False, m_codes=frozenset({25, 26}), **options
    )
    return convert_program(
        text.splitlines(),
        wanted,
        ControlLimits(m_code_outputs={25: ("catcher", True), 26: ("catcher", False)}),
    )


def lines_after(body: str, control: str = "fanuc-a", **options: Any) -> list[str]:
    """Return the converted lines of ``body`` after the usual beginning, without M30."""
    begin = FANUC if control != "linuxcnc" else LINUXCNC
    done = converted(f"{begin}{body}\nM30\n", control, **options)
    assert not done.errors, [each.message for each in done.errors]
    return [each.text for each in done.lines][4:-1]


def refused(body: str, control: str = "fanuc-a", **options: Any) -> tuple[int, int, str]:
    """Return line of the body, column and code of the only error of a program."""
    begin = FANUC if control != "linuxcnc" else LINUXCNC
    done = converted(f"{begin}{body}\nM30\n", control, **options)
    (error,) = done.errors
    return error.line - begin.count("\n"), error.column, error.code
