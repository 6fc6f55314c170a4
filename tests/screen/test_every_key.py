"""Every key on every page in every state of the machine: what it changes is what the page offers.

A page offers the labels of its function keys that are not dim, the lamps that show their key, and what its
prompt names. Keys arrive as the platform sends them, through the keyboard layer.
"""

from __future__ import annotations

import re
import string
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.desk.data_folder import find_data_folder
from app.desk.status.prompt_line import MOVING_STATES, MessageKind
from app.desk.status.state_prompt import find_start_refusal
from app.jog import manual_functions
from app.programs.atomic_files import write_program_file
from app.screen import page_table
from app.screen.page_table import list_pages
from app.screen.window.key_table import AUTOMATIC_KEYS
from core.executor.snapshot import MANUAL_STATES, MachineState
from tests.screen.day import Day, Key, begun
from tests.screen.jog.bench import shipped
from tests.screen.machine_states import MACHINES, STATES
from tests.screen.typist import CTRL, NONE, SHIFT, Stroke, Typist, record

SIGNS = "+-,./ *()"
EDITING = {"Up": "", "Down": "", "Left": "", "Right": "", "PageUp": "", "PageDown": "", "Home": "", "End": ""}
EDITING |= {"Return": "\r", "Backspace": "\b", "Delete": "\x7f", "Tab": "\t", "Insert": "", "Escape": "\x1b"}
STOPS = {"h": "FeedHold", " ": "FeedHold", "e": "press_estop"}  # where no entry has the keyboard
EVERYWHERE = {"+": "feed_pot", "-": "feed_pot", ",": "spindle_pot", ".": "spindle_pot", "t": "setting theme"}
LAMPS = {"S": "single_block", "O": "optional_stop", "C": "cycle_repeat", "P": "no_count", "/": "load"}
LAMPS |= {"A": "set_spindle_auto", "D": "EnableDrives", "R": "Reset"}
LABELS = {
    "REMOVE": {"store"},  # takes a program out of the recently loaded ones
    "READOUT": {"setting readout"},
    "DRIVES": {"EnableDrives"},
    "RESET": {"Reset"},
    "SPN STOP": {"StopSpindle"},
    "SAVE": {"file", "store"},
    "SAV+MENU": {"file", "store"},
    "SAV+LOAD": {"file", "store", "load"},
    **{label: {"store"} for label in ("SET POS.", "UNDO", "ACTIVATE", "TOUCH", "TOUCH L")},
}
"""What a function key may change, by its label; any other changes what is seen, and nothing else."""
ALL = len(MACHINES)
PALMS = frozenset({"press_left", "press_right", "CycleStart"})


def _strokes() -> Iterator[Stroke]:
    for letter in string.ascii_lowercase:
        key = ord(letter.upper())
        yield Stroke(letter, key, letter)
        yield Stroke(letter, key, letter.upper(), SHIFT)
        yield Stroke(letter, key, "", CTRL)
    for sign in string.digits + SIGNS:
        yield Stroke(sign, ord(sign), sign)
    yield Stroke(" ", Key.Key_Space, "", CTRL)
    for modifiers in (NONE, SHIFT, CTRL):
        for n in range(12):
            yield Stroke(f"F{n + 1}", Key.Key_F1 + n, "", modifiers)
        for name, text in EDITING.items():
            yield Stroke(name, Key.__members__[f"Key_{name}"], text, modifiers)
        yield Stroke("Pause", Key.Key_Pause, "", modifiers)
        yield Stroke("ScrollLock", Key.Key_ScrollLock, "", modifiers)


STROKES = tuple(_strokes())
FEWER = tuple(each for each in STROKES if each.modifiers is not SHIFT or len(each.name) > 1)
"""Without capitals: for the editor, in which every key takes longer, and for states like others."""
SOME = frozenset({MachineState.IDLE, MachineState.RUN, MachineState.JOG})  # on the other machines
EVERY = [(kind, state) for kind in MACHINES for state in STATES if kind == "omniturn" or state in SOME]
BY_MACHINE = frozenset({page_table.AUTOMATIC, page_table.JOG, page_table.MDI, page_table.SEARCHTO_PAGE})
"""Pages of all machines that are not the same on each."""


@pytest.fixture
def typists(monkeypatch: pytest.MonkeyPatch) -> list[Typist]:
    """Who types; nothing reaches the machine while there is one."""
    found: list[Typist] = []
    record(monkeypatch, found)
    return found


@pytest.fixture
def day(
    request: pytest.FixtureRequest,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    typists: list[Typist],
) -> Iterator[Day]:
    """A machine with three programs, in the state that the test names."""
    kind, state = request.param
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    programs = MACHINES[kind]
    for name, text in programs.texts.items():
        write_program_file(find_data_folder() / "programs" / f"{name}.{programs.ending}", text.encode())
    machine = shipped(tmp_path, absolute=False) if state is MachineState.HOMING else programs.machine
    with begun(qtbot, machine=machine) as day:
        day.sees(lambda: QApplication.focusWindow() is day.window.windowHandle())
        STATES[state](day)
        assert day.shot.state is state
        yield day
        typists.clear()


# --- what is offered --------------------------------------------------------------------------------------


def offered(day: Day, stroke: Stroke) -> set[str]:
    """What a key may change here, as the screen says it."""
    name = stroke.name
    always = {
        "Pause": {"FeedHold"},
        "ScrollLock": {"press_estop"},
        "Escape": {"FeedHold"} if day.shot.state in MOVING_STATES else set(),
        **dict.fromkeys(("F11", "F12"), PALMS if day.frame.current_page.CAN_START_CYCLES else frozenset()),
    }
    if name in always:
        return set(always[name])
    if name[0] == "F" and len(name) > 1:
        return _of_label(day, int(name[1:])) if stroke.modifiers is NONE else set()
    return _of_entry(day, stroke) if day.frame.has_text_field() else _of_letter(day, stroke)


def _of_letter(day: Day, stroke: Stroke) -> set[str]:
    """Of a key where no entry has the keyboard."""
    frame, page, name = day.frame, day.frame.current_page, stroke.name
    if name in STOPS:
        return {STOPS[name]}
    if page.NAME == page_table.JOG and (found := _of_jog(day, name)):
        return found
    if stroke.modifiers is not NONE:
        return set()
    lit = {lamp.switch_key for lamp in frame.strip.lamps} - frame.strip.hidden_keys
    lit |= AUTOMATIC_KEYS if page is frame.automatic_page else set()
    assert frame.station_dock is not None
    lit |= {"A"} - frame.station_dock.hidden_keys
    lamps = {LAMPS[name.upper()]} if name.upper() in lit & LAMPS.keys() else set()
    return lamps | ({EVERYWHERE[name]} if name in EVERYWHERE else set())


def _of_label(day: Day, number: int) -> set[str]:
    if f"F{number}" in day.frame.key_bar.disabled_keys:
        return set()
    return LABELS.get(day.frame.key_bar.key_labels[number - 1], set())


def _of_entry(day: Day, stroke: Stroke) -> set[str]:
    """Return, where the prompt names it; Ctrl+S of the editor."""
    prompts = f"{day.frame.current_page.prompt_text()} {day.frame.prompt_line.state_text}"
    if stroke.name == "Return" and re.search(r"\bENTER(:| TO )", prompts):
        return {"load", "store"}
    return (
        {"file", "store"}
        if day.frame.current_page.NAME == page_table.EDITOR and stroke.name == "s"
        else set()
    )


def _of_jog(day: Day, name: str) -> set[str]:
    """Arrows while slides may be moved by hand, and what stops the spindle."""
    if manual_functions.MANUAL_KEYS.get(name) == manual_functions.STOP:
        return {"StopSpindle"}
    directions = {each.key_name for each in getattr(day.frame.current_page, "model").directions}  # noqa: B009
    return {"Jog", "JogByStep"} if name in directions and day.shot.state in MANUAL_STATES else set()


# --- what is wrong ----------------------------------------------------------------------------------------


def faults_of_page(typist: Typist, name: str) -> Iterator[str]:
    """What keys change that the page does not offer, and offer without doing it."""
    frame, face = typist.day.frame, typist.face
    whole = typist.day.shot.state in {MachineState.IDLE, MachineState.RUN} and name != page_table.EDITOR
    for stroke in STROKES if whole else FEWER:
        if typist.face != face:
            typist.opens(name)
        typist.clear()
        if frame.theme.is_caret_shown is not frame.current_page.has_text_field():
            yield f"{name}: a caret without an entry, or an entry without its caret"
        for fault in _faults_of_stroke(typist, name, stroke):
            yield f"{name}: {stroke.modifiers.name} {stroke.name} {fault}"


def _faults_of_stroke(typist: Typist, name: str, stroke: Stroke) -> Iterator[str]:
    day, frame = typist.day, typist.day.frame
    may, must, has_field = offered(day, stroke), _must(day, stroke), frame.has_text_field()
    label, barred = _label(frame.key_bar.key_labels, stroke), stroke.name in frame.key_bar.disabled_keys
    done = typist.press(stroke)
    left = name != frame.current_page.NAME
    if left:
        done -= {"StopJog"}
    if done - may:
        yield f"changes {done - may} {sorted(typist.changed)}"
    if left and has_field and len(stroke.name) == 1 and stroke.modifiers is NONE:
        yield "is no text"
    if must - done:
        yield f"does not do {must}"
    refused = bool(day.desk.prompt_line.message) and day.desk.prompt_line.notice_kind is MessageKind.REFUSAL
    if label == "" and (left or done):
        yield "has no label"
    if label and refused is not barred:
        yield f"{label} is {'dim' if barred else 'offered'}: {day.desk.prompt_notice}"


def _must(day: Day, stroke: Stroke) -> set[str]:
    """What a key has to do here: what stops the machine, and what is drawn at the station."""
    if stroke.name in {"Pause", "ScrollLock"}:
        return {"FeedHold" if stroke.name == "Pause" else "press_estop"}
    if not day.frame.has_text_field() and stroke.name in STOPS:
        return {STOPS[stroke.name]}
    dock = day.frame.station_dock
    drawn = dock is not None and stroke.name == "a" and "A" not in dock.hidden_keys
    return {"set_spindle_auto"} if drawn and stroke.modifiers is NONE else set()


def _label(labels: tuple[str, ...], stroke: Stroke) -> str | None:
    """The label of a function key; None of any other key."""
    number = stroke.name[1:] if stroke.name[0] == "F" and stroke.modifiers is NONE else ""
    return labels[int(number) - 1] if number.isdecimal() and int(number) <= len(labels) else None


WORDS = "SCROLL LOCK|PALM BUTTONS|CYCLE START|PAUSE|ESC|RETURN|ENTER|HOME"
NAMED = re.compile(rf"\b(F\d+|{WORDS})\b|(?<!-)\b([B-Z])\b(?![-'])")
KEYS = {"PAUSE": "Pause", "SCROLL LOCK": "ScrollLock", "ESC": "Escape", "ENTER": "Return", "RETURN": "Return"}
KEYS |= {"HOME": "Home", "PALM BUTTONS": "F12", "CYCLE START": "F12"}
NO_KEYS = re.compile(
    r"[A-Z]( AND [A-Z])* NOT HOMED|U WRITES HERE|FOR HOME|NEXT CYCLE START|THEN .*"
    r"|(?<=F1), F\d|\(F11 \+ F12\)"
)
AFTER_TYPING = {"Return", "F2"}  # of a prompt that says TYPE


def named_keys(prompt: str) -> set[str]:
    """The keys that a prompt offers now; not those of a later step, or of what is typed first."""
    clauses = (NO_KEYS.sub("", clause) for clause in re.split(r"[;·]|\. |   ", prompt))
    found = {word or letter for clause in clauses for word, letter in NAMED.findall(clause)}
    keys = {KEYS.get(each, each if each[0] == "F" and len(each) > 1 else each.lower()) for each in found}
    return keys - AFTER_TYPING if "TYPE" in prompt else keys


def faults_of_prompt(typist: Typist, name: str) -> Iterator[str]:
    """Keys that the prompt line offers, and that are refused or are text."""
    frame, desk = typist.day.frame, typist.day.desk
    prompt = frame.prompt_line.state_text
    by_name = {each.name: each for each in STROKES if each.modifiers is NONE}
    for key in sorted(named_keys(prompt)):
        typist.opens(name)
        what = f"{name}: {key} is offered by {prompt!r}"
        if len(key) == 1 and frame.has_text_field():
            yield f"{what} and is text"
        palms = by_name[key].name == "F12"
        typist.press(by_name[key])
        if palms and desk.barred():
            yield f"{what} and is refused: {desk.barred()}"
        elif not palms and desk.prompt_line.message and desk.prompt_line.notice_kind is MessageKind.REFUSAL:
            yield f"{what} and is refused: {desk.prompt_line.message}"


@pytest.mark.parametrize("day", EVERY, indirect=True, ids="-".join)
def test_every_key_does_what_page_offers(day: Day, typists: list[Typist]) -> None:
    typist = Typist(day)
    typists.append(typist)
    faults: list[str] = []
    seen: list[str] = []
    language = day.desk.machine.program_language
    for entry in list_pages(language):
        own = language == "omniturn" or entry.name in BY_MACHINE or len(entry.program_languages) < ALL
        if not own or not typist.opens(entry.name):
            continue
        seen.append(entry.name)
        faults += faults_of_prompt(typist, entry.name)
        typist.opens(entry.name)
        faults += faults_of_page(typist, entry.name)
        assert day.frame.station_dock is not None
        if typist.opens(entry.name) and day.frame.station_dock.is_start_disabled is not bool(
            find_start_refusal(day.desk, day.shot)
        ):
            faults.append(f"{entry.name}: the palm buttons are not as they are drawn")
    typist.opens(page_table.AUTOMATIC)
    assert faults == [], "\n".join(faults)
    assert {page_table.AUTOMATIC, page_table.JOG} < set(seen)


# --- what a prompt offers is carried out ------------------------------------------------------------------


def _refused(day: Day, heard: list[str]) -> list[str]:
    return [*heard, day.shot.start_refusal_reason] if day.shot.start_refusal_reason else heard


ENDS = {
    MachineState.DISABLED: ("D", {MachineState.IDLE}),
    MachineState.FAULT: ("R", {MachineState.DISABLED, MachineState.IDLE}),
    MachineState.HOLD: ("palms", {MachineState.RUN, MachineState.WAIT}),
    MachineState.SINGLE_BLOCK_STOP: (
        "palms",
        {MachineState.RUN, MachineState.WAIT, MachineState.SINGLE_BLOCK_STOP, MachineState.PROGRAM_STOP},
    ),
    MachineState.PROGRAM_STOP: ("palms", {MachineState.RUN, MachineState.WAIT}),
    MachineState.IDLE: ("palms", {MachineState.RUN, MachineState.WAIT}),
    MachineState.RUN: ("Pause", {MachineState.HOLD, MachineState.STOPPING}),
    MachineState.WAIT: ("Pause", {MachineState.HOLD, MachineState.STOPPING}),
    MachineState.STOPPING: ("Pause", {MachineState.HOLD}),
    MachineState.JOG: ("Pause", {MachineState.IDLE}),
    MachineState.HOMING: ("H", {MachineState.IDLE}),
    MachineState.ESTOP: ("Y", {MachineState.DISABLED}),
}
"""The key that the Automatic page offers in each state, and the states that follow."""


@pytest.mark.parametrize("day", [("omniturn", state) for state in STATES], indirect=True, ids=lambda e: e[1])
def test_control_does_what_prompt_offers(day: Day, monkeypatch: pytest.MonkeyPatch) -> None:
    key, states = ENDS[day.shot.state]
    heard: list[str] = []
    before = day.desk.prompt_line.hear
    monkeypatch.setattr(
        type(day.desk.prompt_line),
        "hear",
        lambda _self, event: heard.append(event.text) if event.kind == "refused" else before(event),
    )
    typist = Typist(day, recorded=False)
    if key == "palms":
        day.palms()
    elif key == "Y":
        typist.press(Stroke("u", Key.Key_U, "u"))
        day.run(0.6)
        typist.press(Stroke("y", Key.Key_Y, "y"))
    else:
        typist.press(Stroke(key, Key.__members__[f"Key_{key}"]))
    day.reaches(*states)
    assert _refused(day, heard) == []
