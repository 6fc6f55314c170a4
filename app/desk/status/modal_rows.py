"""Modal state as rows of text for MDI and SEARCHTO, with one row for each group of codes."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.status import formats
from app.desk.translation import mark_untranslated, tr
from core.interpreter.shared.checkpoint import Checkpoint
from core.interpreter.shared.modal_state import ModalState
from core.message import Message
from core.tool_edges import format_edge_name

NO_CODE = formats.NO_VALUE


@dataclass(frozen=True, slots=True)
class ModalRow:
    """One row of the modal state, with its label and the active code. ``key`` is not translated."""

    key: str
    label: str
    active_code: str


def make_modal_rows(modal_state: Checkpoint, program_language: str = "omniturn") -> tuple[ModalRow, ...]:
    """Return the rows of the modal state for the machine's program language, in a fixed order."""
    modal = modal_state.modal
    if program_language != "omniturn":
        return _make_rows(modal_state, program_language)
    return (
        *_geometry(modal),
        *_feeds(modal_state),
        *_spindle(modal),
        ModalRow(
            "c",
            tr("C AXIS"),
            f"{tr('LOCKED')} {formats.format_angle(modal_state.c)}" if modal.c_locked else tr("FREE"),
        ),
        *_frame(modal),
        *_functions(modal),
    )


_MODAL_GROUPS = {
    "klartext": (
        *("tool", "length", "speed", "spindle", "feed", "preset", "datum", "plane", "transform", "tcpm"),
        *("coolant", "outputs"),
    ),
    "sinumerik": (
        *("motion", "settable", "trans", "transformation", "units", "x words", "distance", "tool", "speed"),
        *("spindle", "feed", "coolant", "outputs"),
    ),
}


def _make_rows(point: Checkpoint, language: str) -> tuple[ModalRow, ...]:
    """Return the modal rows for Klartext or SINUMERIK from the saved modal state.

    If no state is saved, the rows show the modal state that a program leaves at its end.
    """
    saved_lines = dict(point.kept.state_lines) if point.kept is not None else {}
    begun = _RESET_CODES | {"speed": f"G97 S{point.modal.rpm:g}"} if language == "sinumerik" else {}
    values = _left_by_program(point.modal) | begun | saved_lines
    labels = _labels()
    return tuple(ModalRow(key, labels[key], values.get(key) or NO_CODE) for key in _MODAL_GROUPS[language])


_RESET_CODES = {
    "motion": "G1",
    "units": "G71 MM",
    "x words": "DIAMON Ø",
    "distance": "G90",
    "feed": "G94",
}
"""Codes that are active in SINUMERIK before the first block and after the end of a program."""


def _left_by_program(modal: ModalState) -> dict[str, str]:
    return {
        "tool": format_edge_name(modal.tool) if modal.tool else "",
        "speed": f"S{modal.rpm:g}" if modal.rpm else "",
        "spindle": {1: "M3", 0: "M5", -1: "M4"}[modal.spindle],
        "coolant": "M8" if modal.coolant else "M9",
        "settable": "G500",
        "tcpm": "M129",
        "outputs": mark_untranslated(" ".join(sorted(name.upper() for name in modal.outputs))),
    }


def _labels() -> dict[str, str]:
    return {
        "tool": tr("TOOL"),
        "length": tr("LENGTH, RADIUS"),
        "speed": tr("SPEED"),
        "spindle": tr("SPINDLE"),
        "feed": tr("FEED"),
        "preset": tr("PRESET"),
        "datum": tr("DATUM SHIFT"),
        "plane": tr("TILTED PLANE"),
        "transform": tr("MIRROR, ROT, SCALE"),
        "tcpm": tr("TCPM"),
        "motion": tr("MOTION"),
        "settable": tr("ZERO OFFSET"),
        "trans": tr("TRANS"),
        "transformation": tr("TRANSFORMATION"),
        "units": tr("UNITS"),
        "x words": tr("X VALUES"),
        "distance": tr("DISTANCE"),
        "coolant": tr("COOLANT"),
        "outputs": tr("M FUNCTIONS"),
    }


def _geometry(modal: ModalState) -> tuple[ModalRow, ...]:
    distance = NO_CODE if modal.absolute is None else "G90" if modal.absolute else "G91"
    coarse = {0: "G36", 1: "G35", 2: "G35F2"}[modal.coarse]
    return (
        ModalRow("units", tr("UNITS"), "G71 MM" if modal.metric else tr("G70 INCH")),
        ModalRow("x words", tr("X VALUES"), "G72 Ø" if modal.diameter else "G73 R"),
        ModalRow("distance", tr("DISTANCE"), distance),
        ModalRow("nose", tr("NOSE COMP"), f"G{modal.compensation_code}"),
        ModalRow("coarse", tr("COARSE FEED"), coarse),
    )


def _feeds(point: Checkpoint) -> tuple[ModalRow, ...]:
    modal = point.modal
    first = formats.format_feed(point.first_feed, modal.metric, False) if point.first_feed else NO_CODE
    return (
        ModalRow("feed mode", tr("FEED MODE"), "G95" if modal.per_rev else "G94"),
        ModalRow("feed", tr("FEED"), _feed(modal.feed, modal.metric, modal.per_rev)),
        ModalRow("rapid", tr("RAPID"), "G00" if modal.rapid else tr("OFF")),
        ModalRow(
            "cut feed",
            tr("G01 FEED"),
            _feed(modal.last_cutting_feed, modal.metric, modal.is_cutting_feed_per_rev),
        ),
        ModalRow("rapid rate", tr("RAPID RATE"), _feed(modal.rapid_rate, modal.metric, False)),
        ModalRow("first feed", tr("RAPID (FIRST F)"), first),
    )


def _feed(value: float | None, metric: bool, per_rev: bool) -> str:
    if value is None:
        return NO_CODE
    return Message(
        "{metric} {metric2}",
        metric=formats.format_feed(value, metric, per_rev),
        metric2=formats.find_feed_unit(metric, per_rev),
    )


def _spindle(modal: ModalState) -> tuple[ModalRow, ...]:
    run = {1: "M03", -1: "M04", 0: "M05"}[modal.spindle]
    surface = formats.format_surface_speed(modal.surface_speed, modal.metric)
    unit = "M/MIN" if modal.metric else "SFM"
    speed = (
        Message("G96 {surface} {unit}", surface=surface, unit=unit)
        if modal.css
        else Message("G97 {rpm} RPM", rpm=formats.rpm(modal.rpm))
    )
    least, most = modal.min_css_rpm, modal.max_css_rpm
    limits = f"{formats.rpm(least)} … {formats.rpm(most) if most is not None else NO_CODE}"
    return (
        ModalRow("spindle", tr("SPINDLE"), run),
        ModalRow("speed", tr("SPEED"), speed),
        ModalRow("clamps", tr("G76 … G77"), limits if least or most is not None else NO_CODE),
    )


def _frame(modal: ModalState) -> tuple[ModalRow, ...]:
    pair = _format_pair
    return (
        ModalRow("tool", tr("TOOL"), format_edge_name(modal.tool)),
        ModalRow("tool offset", tr("TOOL OFFSET"), pair(modal, modal.tool_offset_x, modal.tool_offset_z)),
        ModalRow("secondary", tr("D OFFSET"), f"D{modal.secondary}  {_d(modal)}"),
        ModalRow("shift", tr("G10 ACTIVE"), pair(modal, modal.shift_x, modal.shift_z)),
        ModalRow("pending", tr("G10 FROM NEXT T"), pair(modal, modal.pending_shift_x, modal.pending_shift_z)),
        ModalRow("preset", tr("G92 PRESET"), pair(modal, modal.preset_x, modal.preset_z)),
    )


def _d(modal: ModalState) -> str:
    return _format_pair(modal, modal.secondary_offset_x, modal.secondary_offset_z) if modal.secondary else ""


def _format_pair(modal: ModalState, x: float, z: float) -> str:
    """Return X and Z as text. X has the prefix R because offsets are stored as a radius."""
    if not x and not z:
        return "0"
    return f"R{formats.format_length(x, modal.metric)} Z{formats.format_length(z, modal.metric)}"


def _functions(modal: ModalState) -> tuple[ModalRow, ...]:
    outputs = mark_untranslated(" ".join(sorted(name.upper() for name in modal.outputs))) or NO_CODE
    return (
        ModalRow("coolant", tr("COOLANT"), "M08" if modal.coolant else "M09"),
        ModalRow("collet", tr("COLLET"), "M12" if modal.collet_closed else "M13"),
        ModalRow("outputs", tr("M FUNCTIONS"), outputs),
        ModalRow("comment", tr("COMMENT"), mark_untranslated(modal.comment.strip()) or NO_CODE),
    )
