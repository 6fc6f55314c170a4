"""Registry of the page models and watchers that are attached to TurnDesk."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from app.desk.page_description import ProgramConversion, ProgramKey
from app.desk.pages.attached_parts import AttachedModel, FrameWatcher, GuidanceCard, StartHandler
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.interrupted_notice import NoticeRow
from core.closing_steps import ClosingStep
from core.executor.snapshot import Snapshot

AttachedT = TypeVar("AttachedT", bound=AttachedModel)


@dataclass(slots=True)
class PageRegistry:
    """Page models by class, with start handlers, watchers, notices and program keys.

    ``program_conversion`` is the conversion of programs of other controls, or None without such a feature.
    """

    program_conversion: ProgramConversion | None = None
    _attached: dict[type[AttachedModel], AttachedModel] = field(default_factory=dict)
    _made_later: dict[str, Callable[[], AttachedModel]] = field(default_factory=dict)  # By class name.
    _starts: list[StartHandler] = field(default_factory=list)
    _run_watchers: list[FrameWatcher] = field(default_factory=list)
    _frame_watchers: list[Callable[[Snapshot], None]] = field(default_factory=list)
    _program_keys: dict[str, ProgramKey] = field(default_factory=dict)
    _notice: Callable[[Snapshot], NoticeRow | None] = lambda _snapshot: None
    _guidance_card: GuidanceCard | None = None
    _open_record: Callable[[str], None] = lambda _name: None

    # --- models --------------------------------------------------------------------------------------

    def attach_model(self, model: AttachedModel) -> None:
        """Register the model of a page by its class. The model closes together with TurnDesk."""
        self._attached[type(model)] = model

    def attach_lazy_model(self, model_class: str, make_model: Callable[[], AttachedModel]) -> None:
        """Register a page model that is created by the first call of ``find_model``.

        ``model_class`` is the class name with its module, for example
        ``app.editor.editor_model.EditorModel``.
        """
        self._made_later[model_class] = make_model

    def find_model(self, model_class: type[AttachedT]) -> AttachedT | None:
        """Return the model of this class, or None if no such model is attached."""
        make = self._made_later.pop(f"{model_class.__module__}.{model_class.__qualname__}", None)
        if make is not None:
            self.attach_model(make())
        part = self._attached.get(model_class)
        return part if isinstance(part, model_class) else None

    def make_closing_steps(self) -> list[ClosingStep]:
        """Return the steps that close all models."""
        return [ClosingStep(kind.__name__, part.close) for kind, part in self._attached.items()]

    # --- additions -----------------------------------------------------------------------------------

    def add_start_handler(self, page: StartHandler) -> None:
        """Register a page that uses the start buttons while it is open."""
        self._starts.append(page)

    def add_run_watcher(self, watcher: FrameWatcher) -> None:
        """Register a watcher that observes every frame of a program run, but not of an MDI line."""
        self._run_watchers.append(watcher)

    def add_frame_watcher(self, watcher: Callable[[Snapshot], None]) -> None:
        """Register a function that is called once per frame."""
        self._frame_watchers.append(watcher)

    def add_program_key(self, name: str, key: ProgramKey) -> None:
        """Add a function key to the program list."""
        self._program_keys[name] = key

    def set_notice_finder(self, find_notice: Callable[[Snapshot], NoticeRow | None]) -> None:
        """Set the function that finds a notice to show between cycles, such as about the next job."""
        self._notice = find_notice

    def set_guidance_card(self, card: GuidanceCard) -> None:
        """Set the card that guides the operator on every page."""
        self._guidance_card = card

    def set_recording_opener(self, open_recording: Callable[[str], None]) -> None:
        """Set the function that opens the scope recording of an alarm.

        Its argument is the recording's name.
        """
        self._open_record = open_recording

    # --- uses ----------------------------------------------------------------------------------------

    @property
    def active_start_handler(self) -> StartHandler | None:
        """Return the page that currently uses the start buttons, or None if they start the program."""
        return next((page for page in self._starts if page.is_open), None)

    @property
    def program_keys(self) -> Mapping[str, ProgramKey]:
        """Return the function keys that features add to the program list, by name."""
        return self._program_keys

    @property
    def run_watchers(self) -> Sequence[FrameWatcher]:
        """Return the run watchers in the order of registration."""
        return self._run_watchers

    def notify_run_watchers(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Pass a frame of a program run to the run watchers."""
        for watcher in self._run_watchers:
            watcher.observe_frame(snapshot, loaded)

    def notify_frame_watchers(self, snapshot: Snapshot) -> None:
        """Pass the snapshot of a frame to the frame watchers."""
        for see in self._frame_watchers:
            see(snapshot)

    def find_notice(self, snapshot: Snapshot) -> NoticeRow | None:
        """Return the notice that a feature shows between cycles, or None if there is no notice."""
        return self._notice(snapshot)

    def make_guidance_row(self) -> NoticeRow | None:
        """Return the card that guides the operator, or None if it is closed."""
        return self._guidance_card.make_row() if self._guidance_card is not None else None

    def close_guidance_card(self) -> bool:
        """Close the card that guides the operator, and return False if no such card was open."""
        return self._guidance_card is not None and self._guidance_card.close_card()

    def open_recording(self, name: str) -> None:
        """Open the recording of an alarm in the scope."""
        self._open_record(name)
