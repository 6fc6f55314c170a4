"""[pendant] of the machine file: which device on USB it is; its buttons are inputs at ``pendant.…``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from app.extras.pendant.driver.input_codes import button_of, wheel_of
from core.key_declaration import file_key, key_table
from core.message import Message
from core.table_schema import Driver, DriverTable, FileReading, Finding, written

AT_PENDANT = "pendant."  # begins the address of a button or wheel
_PATH, _WHEEL = "pendant", "io.analog.handwheel"
STOPS = ("hold", "start_inhibit")  # what must not be believed to be there when it is gone
_MAY = re.compile(r"hold|start_inhibit|wheel_\w+|jog_rapid|jog_[xyzabc]_(plus|minus)")
_STARTS = re.compile(r"(cycle_?)?start.*|.*palms?.*|spindle_auto", re.IGNORECASE)
NO_START = (
    "a pendant cannot start anything: Cycle Start must come from the output of a "
    "two-hand relay, wired to a terminal; remove this line"
)


@key_table
class PendantModel:
    """``device`` is its name or ``vendor:product`` in hexadecimal; ``serial`` tells two alike apart.

    ``counts``: its wheel tells steps, as REL says, or its place (0…255), as a Shuttle does.
    """

    device: str = file_key(
        meaning="Name of the USB device or its `vendor:product` in hexadecimal, as "
        "`/proc/bus/input/devices` shows them."
    )
    serial: str = file_key(
        default="", meaning="Serial number, to distinguish two identical devices. Default: any."
    )
    counts: str = file_key(
        default="steps",
        choices=("steps", "place"),
        meaning='"steps": the handwheel reports detents; "place": the handwheel reports its position, 0 to '
        "255, as a Contour Shuttle does.",
    )


def _rules(file: FileReading) -> Iterator[Finding]:
    buttons = _buttons(file)
    for path, terminal in buttons.items():
        if why := _wrong_button(path, terminal):
            yield Finding(f"{path}.at", written(terminal), why)
    yield from _taken(buttons)
    yield from _analog(file)
    used = [*buttons, *([_WHEEL] if _wheel(file) else ())]
    if used and _PATH not in file.tables:
        yield Finding(
            f"[{_PATH}]",
            "",
            Message(
                "this section is missing, but {used} uses the pendant. Set device to the name of the pendant",
                used=used[0],
            ),
        )
    if not used and _PATH in file.tables:
        expected = 'nothing is at it; expected an input such as hold = { at = "pendant.BTN_B" }'
        yield Finding(f"[{_PATH}]", "", expected)


def _buttons(file: FileReading) -> Mapping[str, str]:
    """Return the inputs and outputs that are at the pendant, by path."""
    return {path: at for path, at in file.elsewhere.items() if at.startswith(AT_PENDANT)}


def _wrong_button(path: str, terminal: str) -> str:
    name = path.rpartition(".")[2]
    if path.startswith("io.out."):
        return "a pendant cannot switch an output; expected a terminal of the machine"
    if _STARTS.fullmatch(name) and name != "start_inhibit":
        return NO_START
    if not _MAY.fullmatch(name):
        return Message(
            "{name} cannot be assigned to a pendant, because USB is not suitable for this "
            "signal. Expected hold, start_inhibit, wheel_…, jog_rapid, jog_x_plus or a similar "
            "jog input",
            name=name,
        )
    if button_of(terminal.removeprefix(AT_PENDANT)) is None:
        return (
            "expected the Linux name of a button, for example pendant.BTN_A, pendant.KEY_F13 or "
            "pendant.ABS_HAT0X+"
        )
    return ""


def _taken(buttons: Mapping[str, str]) -> Iterator[Finding]:
    """One button means one thing: whoever presses it does not mean two."""
    taken: dict[object, str] = {}
    for path, terminal in buttons.items():
        code = button_of(terminal.removeprefix(AT_PENDANT))
        first = taken.setdefault(code, path)
        if code is not None and first != path:
            expected = Message("expected an unused button; {first} already uses this button", first=first)
            yield Finding(f"{path}.at", written(terminal), expected)


def _wheel(file: FileReading) -> str:
    """Where the handwheel is at the pendant; empty where it is not."""
    path = f"{_WHEEL}.at"
    at = file.values.text(path) if file.values.has(path) else ""
    return at if at.startswith(AT_PENDANT) else ""


def _analog(file: FileReading) -> Iterator[Finding]:
    values = file.values
    for name in file.names("io.analog"):
        path = f"io.analog.{name}.at"
        if name != "handwheel" and values.has(path) and values.text(path).startswith(AT_PENDANT):
            expected = "expected a terminal; the handwheel is the only analog input that can be on a pendant"
            yield Finding(path, written(values.text(path)), expected)
    if (at := _wheel(file)) and wheel_of(at.removeprefix(AT_PENDANT)) is None:
        expected = "expected the Linux name of a handwheel, for example pendant.REL_DIAL or pendant.ABS_WHEEL"
        yield Finding(f"{_WHEEL}.at", written(at), expected)


DRIVER = Driver(
    tables=(
        DriverTable(
            _PATH,
            PendantModel,
            rules=_rules,
            purpose="A pendant, gamepad or jog dial on USB. Its buttons are inputs of [io.in] at "
            "`pendant.…`; no button can start a cycle or switch an output.",
        ),
    ),
    prefix=AT_PENDANT,
)
