"""An operator in front of the real window: real keys, a real pointer, and eyes."""

from __future__ import annotations

import json
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from core.store.store import Store
from tests.stories.fork_server import ForkServer
from tests.stories.patience import LOOK, PATIENCE, throughout, until
from tests.stories.x11 import MODIFIERS, Server
from tests.texts import begins, shows

INCH = 25.4  # mm
READS = 1.2  # s of looking at the prompt before the palms
READ = 0.6  # s in which a question is read
AGAIN = 3.0  # s behind which somebody does again what has done nothing
MEANS = {"y", "F10"}
HURRY = 5.0  # seconds of machine time per second while a story only waits for the machine
_TRIES = 20  # of a hand that the screen has forgotten behind a stall
NEAR = 0.01  # mm: what a slide at rest may tremble
FINGERTIP = 18  # pixels: 4 mm of a screen of 1024x600 that is 10 inches across
_BESIDE = ((1, 1), (-1, 1), (1, -1), (-1, -1))
Told = dict[str, Any]


class Operator:
    """What he does goes through the X server; what he sees comes from the process, the store and its files.

    Keys are called as X calls them (``F11``, ``Pause``, ``Return``, ``h``); modifiers are ``shift``,
    ``ctrl``, ``alt``, ``meta`` and ``altgr``.
    """

    def __init__(
        self, server: Server, forks: ForkServer, home: Path, *arguments: str, in_real_time: bool = False
    ) -> None:
        self.server, self.home = server, home
        self._meant = 0.0  # when a key was pressed that answers
        self.once = False  # keys are pressed once, whatever the screen says of them
        self.seen: list[Told] = []  # every change of the machine since the start
        self._answers: dict[int, Any] = {}
        self._asked = 0
        self._tapped = 0
        self._window = ""
        self._told = threading.Condition()
        environment = server.environment | {"TURNDESK_HOME": str(home)}
        if in_real_time:
            environment["STORY_IN_REAL_TIME"] = "yes"
        self._errors = (home.parent / "stderr.txt").open("wb")
        self.popen = forks.begins(arguments, environment, self._errors)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        for line in self.popen.stdout:
            told = json.loads(line)
            with self._told:
                if "machine" in told:
                    self.seen.append(told["machine"])
                else:
                    self._answers[told["answer"]] = told["is"]
                self._told.notify_all()

    # --- eyes ------------------------------------------------------------------------------------------

    def ask(self, what: str, **more: object) -> Any:
        """Ask the process, and wait for its answer."""
        number = self.post(what, **more)
        with self._told:
            there = self._told.wait_for(lambda: number in self._answers or self._ended, PATIENCE)
            assert there, f"no answer to {what}"
            assert number in self._answers, f"the process has ended with {self.popen.poll()}: {self.errors}"
            return self._answers.pop(number)

    def post(self, what: str, **more: object) -> int:
        """Ask, and do not wait; the number of the answer."""
        self._asked += 1
        self.popen.stdin.write(json.dumps({"ask": what, "number": self._asked, **more}).encode() + b"\n")
        self.popen.stdin.flush()
        return self._asked

    def answered(self, number: int) -> bool:
        """Whether what was asked is done."""
        return number in self._answers

    @property
    def _ended(self) -> bool:
        return self.popen.poll() is not None

    @property
    def errors(self) -> str:
        """What the process said on standard error."""
        return (self.home.parent / "stderr.txt").read_text()

    @property
    def glance(self) -> Told:
        """Page, state, prompt and the field with the keyboard."""
        return dict(self.ask("glance"))

    @property
    def screen(self) -> Told:
        """The same, and every text with its place."""
        return dict(self.ask("screen"))

    @property
    def prompt(self) -> str:
        """The prompt line."""
        return str(self.glance.get("prompt", ""))

    @property
    def page(self) -> str:
        """The page in front."""
        return str(self.glance.get("page", ""))

    @property
    def machine(self) -> Told:
        """The machine of now; ``slides``: where they really stand, mm from home."""
        return self.seen[-1] if self.seen else {}

    @property
    def state(self) -> str:
        """The state of the machine, as the control has it."""
        return str(self.machine.get("state", ""))

    @property
    def slides(self) -> list[float]:
        """Where the slides really stand, mm from home."""
        return list(self.machine["slides"])

    @property
    def status(self) -> Told:
        """``status.json``."""
        path = self.home / "status.json"
        return dict(json.loads(path.read_text())) if path.exists() else {}

    @contextmanager
    def store(self) -> Iterator[Store]:
        """What is kept."""
        with Store.open(self.home, read_only=True) as store:
            yield store

    def events(self, *kinds: str) -> list[str]:
        """The texts of the event log, the oldest first."""
        with self.store() as store:
            return [event.text for event in reversed(store.events.read_events(limit=1000, kinds=kinds))]

    def shows(self, text: str) -> bool:
        """Whether this stands somewhere on the screen."""
        screen = self.screen
        return any(text in each for each, *_place in screen.get("texts", ())) or text in screen.get(
            "prompt", ""
        )

    # --- waiting ---------------------------------------------------------------------------------------

    def until(self, true: Callable[[], bool], what: object = "") -> None:
        """Wait for it."""
        until(true, lambda: f"{what} is not so: {self.machine}, {self.last_words}")

    def lets_it_run(self, true: Callable[[], bool], what: object = "", until_line: int | None = None) -> None:
        """Wait until ``true`` holds; machine time runs ``HURRY`` times as fast meanwhile.

        ``until_line``: the line of the program at which machine time slows down to real time again.
        """
        self.ask("hurry", rate=HURRY, until_line=until_line)
        try:
            self.until(true, what)
        finally:
            if not self._ended:
                self.ask("hurry", rate=1.0, until_line=None)

    def passes(self, seconds: float) -> None:
        """Wait for so many seconds of machine time, which stops while the computer is too busy."""
        began = self.ask("time")
        self.until(lambda: self.ask("time") - began >= seconds, f"{seconds} s of the machine")

    def was_prompted(self, text: str) -> bool:
        """Return whether the prompt line has shown this text at any moment since the start."""
        return any(text in each for each in self.ask("prompts"))

    def keeps(self, true: Callable[[], bool], seconds: float, what: object = "") -> None:
        """Check that ``true`` holds for so many seconds of machine time."""
        began = self.ask("time")

        def is_over() -> bool:
            assert true(), f"{what} has not stayed so: {self.machine}, {self.last_words}"
            return bool(self.ask("time") - began >= seconds)

        self.until(is_over, f"{seconds} s of the machine")

    def during(self, seconds: float) -> None:
        """A hand does what it does for as long."""
        throughout(seconds, lambda: None)

    def sees(self, text: str) -> None:
        """Wait for a text on the screen."""
        self.until(lambda: self.shows(text), f"{text!r} on the screen")

    def reaches(self, *states: str) -> None:
        """Wait for a state of the machine."""
        self.until(lambda: self.state in states, states)

    def opens(self, page: str) -> None:
        """Wait for a page."""
        self.until(lambda: self.page == page, f"page {page}")

    def rests(self, seconds: float = 0.5) -> list[float]:
        """Wait until the slides stand, and stay; where."""
        at = [self.slides]

        def still() -> bool:
            before, at[0] = at[0], self.slides
            self.passes(0.1)
            return max(abs(a - b) for a, b in zip(before, self.slides, strict=True)) < NEAR

        self.until(still, "rest")
        stands = self.slides
        self.passes(seconds)
        assert self.is_at(stands), f"no rest at {stands}: {self.machine}, {self.last_words}"
        return stands

    def is_at(self, place: Sequence[float]) -> bool:
        """Whether the slides are there."""
        return all(abs(a - b) < NEAR for a, b in zip(place, self.slides, strict=False))

    @property
    def last_words(self) -> Told:
        """What to know when something has gone wrong."""
        if self._ended:
            return {"ended": self.popen.poll(), "stderr": self.errors}
        screen = self.screen
        return {key: screen.get(key) for key in ("page", "state", "prompt", "field", "active")}

    # --- hands -----------------------------------------------------------------------------------------

    def key(self, key: str | int, *modifiers: str) -> None:
        """A key goes down and comes up; modifiers before and after it.

        Where the screen says that it stood still and has forgotten it, it is pressed again, as anybody would.
        """
        if key in MEANS:
            self._meant = time.monotonic()
        held = [MODIFIERS[each] for each in modifiers]
        before = self._forgotten()
        while True:
            seen = self.glance.get("keys", 0) if not self.once else 0
            self.server.down(*held, key)
            self.server.up(key, *reversed(held))
            self._arrives("keys", seen)
            if self.once or self._forgotten() == before:
                return
            before = self._forgotten()

    def _arrives(self, what: str, seen: int) -> None:
        """What was pressed has come to the process, unless the window manager has kept it."""
        if not self.once:
            tries = iter(range(50))
            self.until(lambda: self.glance.get(what, 0) > seen or next(tries, None) is None)

    def _forgotten(self) -> int:
        return 0 if self.once else int(self.glance.get("forgotten", 0))

    def keys(self, *keys: str | int) -> None:
        """One after the other."""
        for key in keys:
            self.key(key)

    def presses(self, key: str, then: Callable[[], bool]) -> None:
        """A key until it has done what it shall; the desk forgets what is pressed while it stands still."""

        def done() -> bool:
            if not then():
                self.key(key)
            return self.soon(then)

        self.until(done, key)

    def answers(self, key: str, question: str, then: Callable[[], bool], yes: str = "y") -> None:
        """A key that asks, and yes to what it asks; once more where the desk stood still meanwhile."""

        def done() -> bool:
            if then():
                return True
            if not self.shows(question):
                self.key(key)
            return self.soon(lambda: self.shows(question)) and self.says_yes(then, yes)

        self.until(done, question)

    def says_yes(self, then: Callable[[], bool], yes: str = "y") -> bool:
        """Yes to the question that stands; nobody has read one sooner than half a second after it came."""
        self.during(READ)
        self.key(yes)
        return self.soon(then)

    def soon(self, true: Callable[[], bool]) -> bool:
        """Whether it becomes so while somebody would wait before he does it again."""
        end = time.monotonic() + AGAIN
        while not true():
            if time.monotonic() > end:
                return False
            self.during(LOOK)
        return True

    def jogs(self, key: str, true: Callable[[], bool], what: str) -> None:
        """An arrow held until it is so; pressed anew where a screen that stood still has ended the jog."""
        self.down(key)

        def there() -> bool:
            if "JOG STOPPED" in self.prompt and not true():
                self.up(key)
                self.during(0.1)
                self.down(key)
            return true()

        self.until(there, what)
        self.up(key)

    def down(self, *keys: str | int) -> None:
        """Keys go down and stay; the server repeats the last one. Forgotten ones are pressed anew."""
        before = self._forgotten()
        self.server.down(*keys)
        while not self.once and self._forgotten() != before:
            before = self._forgotten()
            self.server.up(*keys)
            self.during(0.1)
            self.server.down(*keys)

    def up(self, *keys: str | int) -> None:
        """They come up."""
        self.server.up(*keys)

    def holds(self, key: str | int, seconds: float) -> None:
        """A key is held for as long."""
        self.down(key)
        self.during(seconds)
        self.up(key)

    def writes(self, text: str) -> None:
        """Typed where the keyboard is."""
        self.server.write(text)

    def enters(self, text: str) -> None:
        """Typed, and Return."""
        self.writes(text)
        self.key("Return")

    def find(self, text: str, on: str = "") -> tuple[float, float]:
        """Where this stands on the screen, whole or in something longer; ``on``: a kind of widget."""
        found: list[tuple[float, float]] = []

        def there() -> bool:
            texts = [each for each in self.screen.get("texts", ()) if on in {"", each[3]} and text in each[0]]
            texts.sort(key=lambda each: each[0] != text)
            found.extend((x, y) for _text, x, y, _on in texts)
            return bool(found)

        self.until(there, f"{text!r} on the screen")
        return found[0]

    def points(self, text: str, on: str = "") -> None:
        """The pointer on a text."""
        self.server.point(*self.find(text, on))

    def clicks(self, text: str, on: str = "") -> None:
        """The left button of the mouse on a text; again where the screen has forgotten it behind a stall."""
        self.points(text, on)
        before = self._forgotten()
        while True:
            seen = self.glance.get("clicks", 0) if not self.once else 0
            self.server.button("left", down=True)
            self.server.button("left", down=False)
            self._arrives("clicks", seen)
            if self.once or self._forgotten() == before:
                return
            before = self._forgotten()

    def touches(self, *texts: str, on: str = "") -> None:
        """As many fingers, each on a text; they come up together (inside Qt: XTEST has no touch)."""
        at = [self.find(text, on) for text in texts]
        for number, place in enumerate(at):
            self.finger(number, place)
        self.ask("touch", fingers=[(number, "release", *place) for number, place in enumerate(at)])

    def taps(self, text: str, on: str = "") -> None:
        """One finger, up again, on the target with this text: 4 mm beside its middle, as fingers are."""
        x, y = self._middle(*self.find(text, on))
        self._tapped += 1
        across, down = _BESIDE[self._tapped % len(_BESIDE)]
        at = (x + across * FINGERTIP, y + down * FINGERTIP)
        self.finger(0, at)
        self.ask("touch", fingers=[(0, "release", *at)])

    def _middle(self, x: float, y: float) -> tuple[float, float]:
        """Of the smallest target at a place; it has to be one."""
        there = [
            (wide * high, left + wide / 2, top + high / 2)
            for left, top, wide, high in self.screen["targets"]
            if left <= x <= left + wide and top <= y <= top + high
        ]
        assert there, f"nothing to press at {x}, {y}"
        return min(there)[1:]

    def finger(self, number: int, at: tuple[float, float]) -> None:
        """A finger goes down there, and stays; again where the screen has forgotten it."""
        before = self._forgotten()
        self.ask("touch", fingers=[(number, "press", *at)])
        for _ in range(_TRIES):
            if self._forgotten() == before:
                return
            before = self._forgotten()
            self.ask("touch", fingers=[(number, "release", *at)])
            self.ask("touch", fingers=[(number, "press", *at)])
        raise AssertionError(f"no finger is felt at {at}: {self.last_words}")

    def minimises(self) -> None:
        """The window goes into the task bar."""
        self.server.run("xdotool", "windowminimize", self._window)
        self.until(lambda: not self.glance["active"], "the window away")

    def comes_back(self) -> None:
        """And comes to the front again, with the keyboard."""
        self.server.run("xdotool", "windowactivate", self._window)
        self.until(lambda: bool(self.glance["active"]), "the window back")

    def freezes(self, seconds: float) -> int:
        """Qt's thread does nothing for as long; ``answered`` says when it is over."""
        self.ask("real time")
        return self.post("freeze", seconds=seconds)

    def breaks(self, what: str, *values: object) -> list[float]:
        """Break a part (``jam``, ``spindle_fault``, …); return where the slides are then, mm from home."""
        slides: list[float] = self.ask("break", name=what, values=values)
        return slides

    def stops_the_process(self) -> None:
        """As a debugger or a suspended computer stops it: every thread of it."""
        self.ask("real time")
        self._signal(signal.SIGSTOP)

    def lets_it_go_on(self) -> None:
        """And on."""
        self._signal(signal.SIGCONT)

    def _signal(self, number: int) -> None:
        """Send a signal to the screen, and to its control where that is a process of its own."""
        children = Path(f"/proc/{self.popen.pid}/task/{self.popen.pid}/children").read_text().split()
        for pid in (self.popen.pid, *map(int, children)):
            if pid == self.popen.pid or b"control_process" in Path(f"/proc/{pid}/cmdline").read_bytes():
                os.kill(pid, number)

    # --- what everybody does ---------------------------------------------------------------------------

    def arrives(self) -> None:
        """In front of a desk that is open and has the keyboard."""
        self.until(lambda: bool(self.seen) and bool(self.glance.get("active")), "the window")
        self._window = self.server.run("xdotool", "getactivewindow").strip()

    def drives_on(self) -> None:
        """D, and the machine is ready; once more where a busy computer has forgotten the key."""
        self.reaches("DRIVES OFF")
        self.key("d")
        self.until(lambda: self.state == "READY" or shows(self.prompt, "screen.screen-stood-still"), "READY")
        if self.state == "DRIVES OFF":
            self.during(1.0)
            self.key("d")
        self.reaches("READY")

    def cycle_start(self) -> None:
        """Both palms at once, and hands off; they are held as long as a relay wants it.

        Who has just meant something looks before he starts it.
        """
        self.during(max(0.1, self._meant + READS - time.monotonic()))
        self.down("F11", "F12")
        self.during(0.15)
        self.up("F11", "F12")

    def starts(self, palms: Callable[[], None] | None = None) -> None:
        """Both palms as soon as the prompt offers it.

        Again where a busy computer has forgotten them, or has shown late what is to be looked at before.
        """
        self.until(lambda: "TO START" in self.prompt, "ready to start")
        since = len(self.seen)

        def runs() -> bool:
            return any(each["state"] in {"RUNNING", "WAITING"} for each in self.seen[since:])

        def started() -> bool:
            if not runs():
                (palms or self.cycle_start)()
            if self.soon(runs):
                return True
            refused = str(self.machine["refused"])
            assert not refused or begins(refused, "executor.look-first"), refused
            return False

        self.until(started, "a start")

    # --- the end ---------------------------------------------------------------------------------------

    def leaves(self) -> None:
        """Whatever is left of the process is killed."""
        self.server.let_go()
        if not self._ended:
            os.kill(self.popen.pid, signal.SIGKILL)
        self.popen.wait()
        self._reader.join()
        for each in (self.popen.stdin, self.popen.stdout, self._errors):
            try:
                each.close()
            except BrokenPipeError:
                continue  # what was still to be asked
