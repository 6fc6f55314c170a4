"""The live tool as spindle 2: S2=, M2=3, M2=5, and S, M3, M5 while SETMS(2) makes it the master."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.actions import Output
from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.sinumerik_state import State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import Word
from core.language.sinumerik.word_table import DWELL
from core.message import Message

NUMBER = 2
_TURNS = frozenset({3, 4, 5})


def live_words(state: State, statement: Statement) -> None:
    """Take out of the block what is meant for the live tool. Raises ProgramError where there is none."""
    for word in statement.live:
        _demand(state, statement, word)
    masters = [
        each for each in (*statement.live, statement.words.get("SETMS")) if each and each.name == "SETMS"
    ]
    if masters:
        state.master = NUMBER if masters[0].spindle == NUMBER else 1
    if state.master != NUMBER or DWELL in statement.g:
        return
    if (speed := statement.words.get("S")) and not speed.spindle:
        statement.live.append(statement.words.pop("S"))
    for code in _TURNS & statement.m.keys():
        if not statement.m[code].spindle:
            statement.live.append(statement.m.pop(code))


def _demand(state: State, statement: Statement, word: Word) -> None:
    text = "{word}: this machine has one spindle and no output for a live tool."
    hint = "Remove this word, or define an output named live under [io.out] in the machine file."
    statement.check(state.setup.limits.live_output, word, "one-spindle", text, hint, word=word.text)


def live_tool(state: State, statement: Statement) -> Iterator[Block]:
    """Speed and start or stop of the live tool. Raises ProgramError."""
    for word in statement.live:
        if word.name == "S":
            _speed(state, statement, word)
    for word in statement.live:
        if word.name == "M":
            yield from _turn(state, statement, word)


def _speed(state: State, statement: Statement, word: Word) -> None:
    value = state.number(statement, word)
    text = "{word}: the speed cannot be negative; M3 and M4 set the direction."
    statement.check(value >= 0.0, word, "speed-sign", text, "Remove the sign.", word=word.text)
    state.live_speed = value
    if state.live_rpm:
        state.live_rpm = value
    if "live-speed" not in state.told:
        state.told.add("live-speed")
        text = Message(
            "{word}: this machine only switches the live tool on and off; the speed is set at "
            "the drive of the live tool.",
            word=word.text,
        )
        state.log.add(
            statement.warning(
                word,
                "live-speed",
                text,
                Message("Set the live tool to {value} rpm by hand.", value=f"{value:g}"),
            )
        )


def _turn(state: State, statement: Statement, word: Word) -> Iterator[Block]:
    code = int(word.value or 0)
    text = "{word}: the live tool turns in only one direction."
    hint = "Write M3, and use a tool that cuts in that direction."
    statement.check(code != 4, word, "live-direction", text, hint, word=word.text)
    on = code == 3
    if on and not state.live_speed:
        text = "{word} starts the live tool, but its speed is not programmed with S."
        raise statement.refuse(word, "speed-missing", text, "Write S2= in the block.", word=word.text)
    state.live_rpm = state.live_speed if on else 0.0
    name = state.setup.limits.live_output
    outputs = state.modal.outputs | {name} if on else state.modal.outputs - {name}
    state.adopt(state.modal._replace(outputs=outputs))
    yield state.action(statement.line.number, word.text, Output(name, on))
