"""Rules for a handwheel with its switches, for jog buttons, and against inputs for palm buttons."""

from __future__ import annotations

import re
from collections.abc import Iterator

from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import FileFinding, MachineFileReading

HANDWHEEL_INPUT = "handwheel"
HANDWHEEL_ENABLE_INPUT = "wheel_enable"  # pressed while the handwheel may move an axis
STEP_FACTORS = {"wheel_x1": 1, "wheel_x10": 10, "wheel_x100": 100}  # times the smallest step
AXIS_BUTTON, STEP_BUTTON = "wheel_axis", "wheel_step"  # each press selects the next axis, the next step
JOG_RAPID_INPUT = "jog_rapid"  # pressed together with a jog button


def get_axis_selector_input(axis_name: str) -> str:
    """Return the name of the input that is on while the axis selector switch selects this axis."""
    return f"wheel_{axis_name.lower()}"


def get_jog_button_input(axis: str, sign: int) -> str:
    """Return the name of the input of the jog button for this axis and direction."""
    return f"jog_{axis.lower()}_{'plus' if sign > 0 else 'minus'}"


def check_jog_buttons(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield a finding for every jog button whose axis does not exist."""
    known = [JOG_RAPID_INPUT, *(get_jog_button_input(axis, sign) for axis in file.axes for sign in (1, -1))]
    for name in file.list_table_keys("io.in"):
        if name.startswith("jog_") and name not in known:
            yield FileFinding(
                Message("io.in.{name}", name=name),
                "",
                Message("this input is not a jog button; use one of {known}", known=", ".join(known)),
                "broken-rule",
            )


def check_handwheel(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield a finding for every invalid handwheel count and every unknown handwheel switch."""
    values, analog = file.file_values, file.list_table_keys("io.analog")
    for name in analog:
        path = f"io.analog.{name}.counts_per_click"
        if values.has_values(path) and name == HANDWHEEL_INPUT and values.read_number(path) == 0:
            yield FileFinding(
                path,
                "0",
                "this value must be a number of counts, negative if the handwheel turns in the "
                "opposite direction",
                "broken-rule",
            )
        if values.has_values(path) and name != HANDWHEEL_INPUT and values.read_number(path) != 1:
            yield FileFinding(
                path,
                f"{values.read_number(path):g}",
                "an override potentiometer has no detents; remove this key",
                "broken-rule",
            )
    selectors = [get_axis_selector_input(axis) for axis in file.axes]
    known = [HANDWHEEL_ENABLE_INPUT, *STEP_FACTORS, *selectors, AXIS_BUTTON, STEP_BUTTON]
    there = file.list_table_keys("io.in")
    for button, switches in ((AXIS_BUTTON, selectors), (STEP_BUTTON, list(STEP_FACTORS))):
        if button in there and (also := [name for name in switches if name in there]):
            why = Message(
                "{also} already makes this selection; use either the button or the switches, not both",
                also=also[0],
            )
            yield FileFinding(f"io.in.{button}", "", why, "broken-rule")
    for name in there:
        if name.startswith("wheel_") and name not in known:
            yield FileFinding(
                Message("io.in.{name}", name=name),
                "",
                Message("this input is not a handwheel switch; use one of {known}", known=", ".join(known)),
                "broken-rule",
            )
        elif name.startswith("wheel_") and HANDWHEEL_INPUT not in analog:
            at = (
                format_toml_value(values.text(f"io.in.{name}.at"))
                if values.has_values(f"io.in.{name}.at")
                else ""
            )
            yield FileFinding(
                f"io.in.{name}",
                at,
                "this input is a handwheel switch; add the handwheel under [io.analog]",
                "broken-rule",
            )


# --- Palm buttons: rejected at the control, because only a two-hand relay can check both hands. ---


_PALM = re.compile(
    r"(left|right)?_?palms?_?(left|right|\d)?|(left|right)_start|start_?(left|right|\d)", re.IGNORECASE
)
WHY = (
    "do not wire palm buttons to the control; use a two-hand relay, which checks that "
    "both buttons are pressed within 0.5 s of each other and released between starts; "
    "wire the single output of the relay to the input named start"
)


def check_palm_buttons(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield a finding for every input that is one of two palm buttons.

    The control must not read palm buttons individually.
    """
    for name in file.list_table_keys("io.in"):
        if _PALM.fullmatch(name):
            yield FileFinding(f"io.in.{name}", "", WHY, "broken-rule")
