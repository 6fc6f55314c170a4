"""The pages and watchers that are attached to TurnDesk."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from app.desk.page_description import ProgramKey
from app.desk.pages.desk_parts import Attached, OwnStart, Watcher
from app.desk.programs.program_loading import Loaded
from app.desk.status.interrupted_notice import NoticeRow
from core.closing import ClosingStep
from core.executor.snapshot import Snapshot

A = TypeVar("A", bound=Attached)


@dataclass(slots=True)
class PageRegistry:
    """Models of pages by class, with their start handlers, watchers, notices and program keys."""

    _attached: dict[type[Attached], Attached] = field(default_factory=dict)
    _made_later: dict[str, Callable[[], Attached]] = field(default_factory=dict)  # By class name.
    _starts: list[OwnStart] = field(default_factory=list)
    _run_watchers: list[Watcher] = field(default_factory=list)
    _frame_watchers: list[Callable[[Snapshot], None]] = field(default_factory=list)
    _program_keys: dict[str, ProgramKey] = field(default_factory=dict)
    _notice: Callable[[Snapshot], NoticeRow | None] = lambda _snapshot: None
    _open_record: Callable[[str], None] = lambda _name: None

    # --- models --------------------------------------------------------------------------------------

    def attach(self, part: Attached) -> None:
        """Register the model of a page by its class. The model is closed with TurnDesk."""
        self._attached[type(part)] = part

    def attach_later(self, kind: str, make: Callable[[], Attached]) -> None:
        """Register a model that is created at the first ``find``.

        ``kind`` is the class name with its module, for example ``app.editor.editor.Editor``.
        """
        self._made_later[kind] = make

    def find(self, kind: type[A]) -> A | None:
        """Return the model of this class, or None if no such model is attached."""
        make = self._made_later.pop(f"{kind.__module__}.{kind.__qualname__}", None)
        if make is not None:
            self.attach(make())
        part = self._attached.get(kind)
        return part if isinstance(part, kind) else None

    def closing_steps(self) -> list[ClosingStep]:
        """Return the steps that close all models."""
        return [ClosingStep(kind.__name__, part.close) for kind, part in self._attached.items()]

    # --- additions -----------------------------------------------------------------------------------

    def add_start(self, page: OwnStart) -> None:
        """Register a page that uses the start buttons while it is open."""
        self._starts.append(page)

    def add_run_watcher(self, watcher: Watcher) -> None:
        """Register a watcher that sees each frame except the frames of an MDI line."""
        self._run_watchers.append(watcher)

    def add_frame_watcher(self, see: Callable[[Snapshot], None]) -> None:
        """Register a function that is called once a frame."""
        self._frame_watchers.append(see)

    def add_program_key(self, name: str, key: ProgramKey) -> None:
        """Add a function key to the program list."""
        self._program_keys[name] = key

    def set_notice(self, notice: Callable[[Snapshot], NoticeRow | None]) -> None:
        """Set the function that returns a notice between cycles, for example for the next job."""
        self._notice = notice

    def set_record_opener(self, open_record: Callable[[str], None]) -> None:
        """Set the function that opens the recording of an alarm by its name."""
        self._open_record = open_record

    # --- uses ----------------------------------------------------------------------------------------

    @property
    def open_start(self) -> OwnStart | None:
        """The page that uses the start buttons now. None: they start the program."""
        return next((page for page in self._starts if page.open), None)

    @property
    def program_keys(self) -> Mapping[str, ProgramKey]:
        """The function keys that features add to the program list, by name."""
        return self._program_keys

    @property
    def run_watchers(self) -> Sequence[Watcher]:
        """The watchers of runs, in the order of registration."""
        return self._run_watchers

    def see_run(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Pass a frame of a program run to the run watchers."""
        for watcher in self._run_watchers:
            watcher.see(snapshot, loaded)

    def see_frame(self, snapshot: Snapshot) -> None:
        """Pass a frame to the frame watchers."""
        for see in self._frame_watchers:
            see(snapshot)

    def offered_notice(self, snapshot: Snapshot) -> NoticeRow | None:
        """Return the notice that a feature offers between cycles, or None."""
        return self._notice(snapshot)

    def open_record(self, name: str) -> None:
        """Open the recording of an alarm in the scope."""
        self._open_record(name)
