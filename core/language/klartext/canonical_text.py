"""Conversion of Klartext lines to the notation of the control.

The conversion normalizes signs, the order of words and blanks.
"""

from __future__ import annotations

from core.language.klartext import klartext_nodes as nodes
from core.language.klartext import klartext_words
from core.message import Message

_FEEDS = {"max": "FMAX", "auto": "F AUTO"}


def format_block(line: nodes.KlartextLine) -> str:
    """Return the block of a line without its number and comment.

    Returns an empty string if the line does not contain a block.
    """
    return "" if line.node is None else _block(line.node) or line.block_text


def _block(node: nodes.Node) -> str:
    match node:
        case nodes.PathFunction():
            return _path(node)
        case nodes.PlaneBlock():
            return _joined("PLANE", node.definition_kind, _axes(node.words), _positioning(node.positioning))
        case nodes.MFunctionBlock():
            return _codes(node.m_functions)
        case nodes.ToolCall():
            return _tool_call(node)
        case nodes.DatumShift():
            return _datum(node)
        case _:
            return _short(node)


def _short(node: nodes.Node) -> str:
    made = ""
    match node:
        case nodes.BeginBlock() | nodes.EndBlock():
            unit = "INCH" if node.is_inch else "MM"
            name = "BEGIN" if isinstance(node, nodes.BeginBlock) else "END"
            made = _joined(Message("{name} PGM", name=name), node.name, unit)
        case nodes.BlankCorner():
            made = _joined(
                Message("BLK FORM 0.{part}", part=node.corner_number), node.tool_axis, _axes(node.axis_words)
            )
        case nodes.Label():
            made = Message("LBL {part}", part=format_name(node.name))
        case nodes.LabelCall():
            repeat = (
                ""
                if node.repeat_count is None
                else Message("REP {repeat}", repeat=_value(node.repeat_count, plus=False))
            )
            made = _joined("CALL LBL", format_name(node.name), repeat)
        case nodes.HeadingLine():
            made = f"* - {node.text}"
    return made


def _path(node: nodes.PathFunction) -> str:
    turn = f"DR{node.rotation_direction}" if node.rotation_direction else ""
    compensation = f"R{node.compensation}" if node.compensation else ""
    words = (node.function_name, _axes(node.axis_words), _axes(node.words), turn, compensation)
    return _joined(*words, _feed(node.feed), _codes(node.m_functions))


def _tool_call(node: nodes.ToolCall) -> str:
    words = (
        ("S", node.speed),
        (f"F{node.feed_unit_letter}", node.feed),
        ("DL", node.delta_length),
        ("DR", node.delta_radius),
        ("DR2:", node.corner_radius),
    )
    tool = _value(node.tool, plus=False) if isinstance(node.tool, klartext_words.Value) else ""
    if isinstance(node.tool, (int, str)):
        tool = format_name(node.tool)
    shown = [f"{word}{_value(value, plus=word[0] == 'D')}" for word, value in words if value is not None]
    if node.cutting_speed is not None:
        shown.append(f"S(VC = {_value(node.cutting_speed, plus=False)})")
    return _joined("TOOL CALL", tool, node.tool_axis, *shown)


def _datum(node: nodes.DatumShift) -> str:
    if node.cycle_number is not None:
        return _joined(
            Message("CYCL DEF 7.{cycle}", cycle=node.cycle_number), node.text, _axes(node.axis_words)
        )
    return "TRANS DATUM RESET" if node.is_reset else _joined("TRANS DATUM AXIS", _axes(node.axis_words))


def _positioning(made: nodes.RotaryPositioning) -> str:
    distance = (
        ""
        if made.rotation_center_distance is None
        else f"DIST{_value(made.rotation_center_distance, plus=False)}"
    )
    return _joined(
        made.mode, distance, _retract(made.retract), _feed(made.feed), made.solution, made.rotation_mode
    )


def _codes(codes: tuple[klartext_words.MFunction, ...]) -> str:
    return " ".join(_joined(f"M{code.number}", _retract(code.retract), _feed(code.feed)) for code in codes)


def _axes(words: tuple[klartext_words.AxisWord, ...]) -> str:
    return " ".join(f"{'I' if word.is_incremental else ''}{word.axis}{_value(word.value)}" for word in words)


def _feed(feed: klartext_words.FeedWord | None) -> str:
    if feed is None:
        return ""
    return (
        _FEEDS[feed.feed_kind]
        if feed.value is None
        else f"F{feed.feed_unit_letter}{_value(feed.value, plus=False)}"
    )


def _retract(retract: klartext_words.RetractWord | None) -> str:
    if retract is None:
        return ""
    return "MB MAX" if retract.distance is None else f"MB{_value(retract.distance, plus=False)}"


def _value(value: klartext_words.Value, *, plus: bool = True) -> str:
    if value.parameter_number is not None:
        return (
            f"{'-' if value.is_negative else '+' if plus else ''}{value.parameter_kind}"
            f"{value.parameter_number}"
        )
    return f"{value.number:{'+' if plus else ''}.9f}".rstrip("0").rstrip(".")


def format_name(name: int | str) -> str:
    """Return the number of a label or tool as text, or its name in quotation marks."""
    return f'"{name}"' if isinstance(name, str) else str(name)


def _joined(*parts: str) -> str:
    return " ".join(part for part in parts if part)
