"""Klartext lines in the notation of the control: signs, order of words and single blanks."""

from __future__ import annotations

from core.language.klartext import klartext_nodes as nodes
from core.message import Message

_FEEDS = {"max": "FMAX", "auto": "F AUTO"}


def written(line: nodes.KlartextLine) -> str:
    """Return the block of a line without its number and comment; empty if the line has no block."""
    return "" if line.node is None else _block(line.node) or line.code


def _block(node: nodes.Node) -> str:
    match node:
        case nodes.Move():
            return _path(node)
        case nodes.Plane():
            return _joined("PLANE", node.form, _axes(node.words), _positioning(node.positioning))
        case nodes.Codes():
            return _codes(node.codes)
        case nodes.ToolCall():
            return _tool_call(node)
        case nodes.Datum():
            return _datum(node)
        case _:
            return _short(node)


def _short(node: nodes.Node) -> str:
    made = ""
    match node:
        case nodes.Begin() | nodes.End():
            unit = "INCH" if node.inch else "MM"
            made = _joined(Message("{name} PGM", name=type(node).__name__.upper()), node.name, unit)
        case nodes.BlankForm():
            made = _joined(Message("BLK FORM 0.{part}", part=node.part), node.tool_axis, _axes(node.corner))
        case nodes.Label():
            made = Message("LBL {part}", part=name_text(node.name))
        case nodes.Call():
            repeat = (
                "" if node.repeat is None else Message("REP {repeat}", repeat=_value(node.repeat, plus=False))
            )
            made = _joined("CALL LBL", name_text(node.name), repeat)
        case nodes.Heading():
            made = f"* - {node.text}"
    return made


def _path(node: nodes.Move) -> str:
    turn = f"DR{node.turn}" if node.turn else ""
    compensation = f"R{node.compensation}" if node.compensation else ""
    words = (node.form, _axes(node.axes), _axes(node.words), turn, compensation)
    return _joined(*words, _feed(node.feed), _codes(node.codes))


def _tool_call(node: nodes.ToolCall) -> str:
    words = (("S", node.speed), (f"F{node.feed_per}", node.feed), ("DL", node.length), ("DR", node.radius))
    tool = _value(node.tool, plus=False) if isinstance(node.tool, nodes.Value) else ""
    if isinstance(node.tool, (int, str)):
        tool = name_text(node.tool)
    shown = [f"{word}{_value(value, plus=word[0] == 'D')}" for word, value in words if value is not None]
    return _joined("TOOL CALL", tool, node.tool_axis, *shown)


def _datum(node: nodes.Datum) -> str:
    if node.cycle is not None:
        return _joined(Message("CYCL DEF 7.{cycle}", cycle=node.cycle), node.text, _axes(node.axes))
    return "TRANS DATUM RESET" if node.reset else _joined("TRANS DATUM AXIS", _axes(node.axes))


def _positioning(made: nodes.Positioning) -> str:
    distance = "" if made.distance is None else f"DIST{_value(made.distance, plus=False)}"
    return _joined(made.way, distance, _retract(made.retract), _feed(made.feed), made.side, made.rotation)


def _codes(codes: tuple[nodes.MCode, ...]) -> str:
    return " ".join(_joined(f"M{code.number}", _retract(code.retract), _feed(code.feed)) for code in codes)


def _axes(words: tuple[nodes.AxisWord, ...]) -> str:
    return " ".join(f"{'I' if word.incremental else ''}{word.axis}{_value(word.value)}" for word in words)


def _feed(feed: nodes.Feed | None) -> str:
    if feed is None:
        return ""
    return _FEEDS[feed.kind] if feed.value is None else f"F{feed.per}{_value(feed.value, plus=False)}"


def _retract(way: nodes.Retract | None) -> str:
    if way is None:
        return ""
    return "MB MAX" if way.distance is None else f"MB{_value(way.distance, plus=False)}"


def _value(value: nodes.Value, *, plus: bool = True) -> str:
    if value.q is not None:
        return f"{'-' if value.negative else '+' if plus else ''}{value.kind}{value.q}"
    return f"{value.number:{'+' if plus else ''}.9f}".rstrip("0").rstrip(".")


def name_text(name: int | str) -> str:
    """Return the number of a label or tool, or its name in quotation marks."""
    return f'"{name}"' if isinstance(name, str) else str(name)


def _joined(*parts: str) -> str:
    return " ".join(part for part in parts if part)
