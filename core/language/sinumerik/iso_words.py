"""Words of the ISO mode and of similar controls, with their SINUMERIK equivalents."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

from core.language.line_reading import SIGNED_NUMBER
from core.message import Message


class IsoWord(NamedTuple):
    """A word of another control, with the index of its start, its explanation and the remedy."""

    start_index: int
    explanation: str
    remedy: str


_Rule = tuple[re.Pattern[str], Callable[[re.Match[str]], tuple[str, str]]]


def _g(codes: str) -> str:
    """Return a pattern for these G codes, with or without leading zeros."""
    return rf"(?<![A-Z0-9_])G0*(?:{codes})(?![0-9.])"


def _seconds(letter: str, number: str) -> str:
    """Return the time of a dwell in seconds, as text; P without a decimal point is in milliseconds."""
    value = float(number)
    return f"{value / 1000.0 if letter == 'P' and '.' not in number else value:g}"


def _dwell(match: re.Match[str]) -> tuple[str, str]:
    letter, number = match["letter"], match["number"]
    text = Message(
        "{letter}{number} is the dwell time in ISO programs; on this control, F is the dwell "
        "time in seconds.",
        letter=letter,
        number=number,
    )
    return text, Message("Write G4 F{letter}.", letter=_seconds(letter, number))


def _radius(match: re.Match[str]) -> tuple[str, str]:
    number = match["number"].rstrip(".")
    return Message(
        "R{number}: on this control, CR={number2} is the radius of an arc.", number=number, number2=number
    ), Message("Write CR={number}.", number=number)


def _corner(match: re.Match[str]) -> tuple[str, str]:
    number = match["number"].rstrip(".")
    word = f"CHR={number}" if match["letter"] == "C" else f"RND={number}"
    return Message(
        "{match}: on this control, the corner is programmed with {word}.", match=match["word"], word=word
    ), Message("Write {name}.", name=word)


def _variable(match: re.Match[str]) -> tuple[str, str]:
    return Message("#{word}: on this control, variables are R parameters.", word=match["number"]), Message(
        "Write R{word}.", word=match["number"]
    )


def _home(match: re.Match[str]) -> tuple[str, str]:
    return (
        Message("{word}: on this control, G74 moves to home and G75 to a fixed point.", word=match["word"]),
        "Write G74 X1=0 Z1=0.",
    )


def _speed_limit(match: re.Match[str]) -> tuple[str, str]:
    return (
        Message("{word}: on this control, LIMS= sets the maximum spindle speed.", word=match["word"]),
        Message("Write LIMS={word}.", word=match["number"].rstrip(".")),
    )


def _preset(match: re.Match[str]) -> tuple[str, str]:
    return (
        Message(
            "{word} presets a position in ISO programs; on this control, TRANS shifts the zero point.",
            word=match["word"],
        )
    ), "Write TRANS."


def _cycle(match: re.Match[str]) -> tuple[str, str]:
    code = int(match["code"])
    name = {74: "CYCLE83", 75: "CYCLE93", 76: "CYCLE97", 32: "G33", 92: "CYCLE97"}.get(code, "CYCLE95")
    return Message("On this control, ISO code G{code} is {name}.", code=code, name=name), Message(
        "Write {name}.", name=name
    )


def _inches(match: re.Match[str]) -> tuple[str, str]:
    name = "G70" if match["code"] == "20" else "G71"
    return Message("G{word}: on this control, {name} sets the unit.", word=match["code"], name=name), Message(
        "Write {name}.", name=name
    )


def _feed(match: re.Match[str]) -> tuple[str, str]:
    name = "G94" if match["code"] == "98" else "G95"
    return Message(
        "G{word}: on this control, {name} sets the feed type.", word=match["code"], name=name
    ), Message("Write {name}.", name=name)


def _call(match: re.Match[str]) -> tuple[str, str]:
    number = match["number"]
    return Message("{word}: on this control, a subprogram is called by name.", word=match["word"]), Message(
        "Write L{number}.", number=number
    )


def _program(match: re.Match[str]) -> tuple[str, str]:
    return Message("{word}: on this control, the file name is the program name.", word=match["word"]), (
        "Remove this text from the program."
    )


def _comment(match: re.Match[str]) -> tuple[str, str]:
    del match
    return (
        "comments in parentheses are for ISO programs; on this control, a comment begins "
        "with a semicolon (;)."
    ), ("Write ; before the comment.")


def _jump(match: re.Match[str]) -> tuple[str, str]:
    number = match["number"]
    return (
        Message(
            "GOTO {number}: on this control, the target of a jump is a label or a block number with N.",
            number=number,
        ),
        Message("Write GOTO N{number}.", number=number),
    )


def _distance(match: re.Match[str]) -> tuple[str, str]:
    axis = {"U": "X", "W": "Z"}[match["letter"]]
    word = f"{axis}=IC({match['number']})"
    return (
        (
            Message(
                "{match}: on this control, use {word} for incremental moves; this lathe has no {word2} axis.",
                match=match["word"],
                word=word,
                word2=match["letter"],
            )
        ),
        Message("Write {name}.", name=word),
    )


_RULES: tuple[_Rule, ...] = (
    (re.compile(r"^\s*\("), _comment),
    (re.compile(r"^\s*(?P<word>O[0-9]+)"), _program),
    (re.compile(r"(?P<word>#(?P<number>[0-9]+))"), _variable),
    (
        re.compile(rf"{_g('4')}(?!.*[FS][0-9=.]).*?(?<![A-Z])(?P<letter>[XUP])(?P<number>{SIGNED_NUMBER})"),
        _dwell,
    ),
    (re.compile(rf"(?P<word>{_g('28|30')})"), _home),
    (re.compile(rf"(?P<word>{_g('50|92')})\s*S(?P<number>{SIGNED_NUMBER})"), _speed_limit),
    (re.compile(rf"(?<![A-Z0-9_])G(?P<code>7[0-6])(?=.*(?<![A-Z])[PQRUW]{SIGNED_NUMBER})"), _cycle),
    (re.compile(rf"(?<![A-Z0-9_])G(?P<code>32|92)(?=.*F{SIGNED_NUMBER})"), _cycle),
    (re.compile(rf"(?P<word>{_g('50|92')})"), _preset),
    (re.compile(r"(?<![A-Z0-9_])G(?P<code>20|21)(?![0-9.])"), _inches),
    (re.compile(r"(?<![A-Z0-9_])G(?P<code>98|99)(?![0-9.])"), _feed),
    (re.compile(r"(?P<word>M98)\s*P0*(?P<number>[0-9]+)"), _call),
    (re.compile(r"GOTO\s*(?P<number>[0-9]+)"), _jump),
    (re.compile(rf"(?P<word>,\s*(?P<letter>[CR])(?P<number>{SIGNED_NUMBER}))"), _corner),
    (re.compile(rf"{_g('2|3')}.*?(?<![A-Z])R(?P<number>{SIGNED_NUMBER})"), _radius),
    (re.compile(rf"{_g('1')}.*?(?<![A-Z])(?P<word>(?P<letter>R)(?P<number>{SIGNED_NUMBER}))"), _corner),
    (re.compile(rf"(?<![A-Z0-9_])(?P<word>(?P<letter>[UW])(?P<number>{SIGNED_NUMBER}))"), _distance),
)
"""Rules for words of the ISO dialect, used only for lines that SINUMERIK cannot read.

The first rule that matches is reported.
"""


def find_iso_word(code: str) -> IsoWord | None:
    """Return the first ISO word of a block, or None if the block has no ISO word.

    ``code`` is the block in capitals, without its comment.
    """
    for pattern, explain_match in _RULES:
        if match := pattern.search(code):
            groups = match.groupdict()
            part = next((name for name in ("word", "letter", "code", "number") if groups.get(name)), 0)
            at = match.start(part)
            return IsoWord(at - (part == "code"), *explain_match(match))
    return None
