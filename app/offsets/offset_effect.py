"""Effect of an offset change on the loaded program: its path with the old and the new offsets.

A changed tool offset moves the real tool tip. Both paths are therefore drawn in the coordinate frame of the
old offsets. The distance between them then equals the distance that the tip will move.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from app.desk.background_work import LatestRequestWorker, ProgressCallback
from app.desk.status.formats import format_length
from app.desk.translation import tr
from app.offsets.active_offsets import make_secondary_offsets, make_tool_offsets
from app.offsets.offset_table import OffsetTable
from core.executor.job import Job
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.message import Message
from core.store.store_rows import OffsetChange, OffsetKind, SecondaryOffsetRow, ToolOffsetRow

if TYPE_CHECKING:
    from app.path.path_picture import ProgramPicture
    from core.proving.offset_comparison import OffsetComparisonResult

    # Arguments: the job with old and new offsets. Returns None if the program makes no part.
    ComparePart = Callable[[Job, Job, ProgressCallback], OffsetComparisonResult | None]

EQUALITY_TOLERANCE_MM = 1e-9  # Millimeters.
OffsetRowT = TypeVar("OffsetRowT", ToolOffsetRow, SecondaryOffsetRow)


@dataclass(frozen=True, slots=True)
class OffsetTables:
    """Tool offsets and secondary offsets in the form that the interpreter uses."""

    tool_offsets: Mapping[int, ToolOffset] = field(default_factory=dict)
    secondary_offsets: Mapping[int, SecondaryOffset] = field(default_factory=dict)


# Arguments: job, tools that define the frame of the drawing, and progress function.
DrawPaths = Callable[[Job, Mapping[int, ToolOffset], ProgressCallback], "ProgramPicture"]


@dataclass(frozen=True, slots=True)
class ComparedPaths:
    """Paths of a program with the old and the new offsets, in one coordinate frame."""

    picture_before: ProgramPicture
    picture_after: ProgramPicture
    # Largest distance of corresponding points in mm; inf if the paths have different moves.
    largest_distance_mm: float = 0.0

    @property
    def has_no_effect(self) -> bool:
        """Return whether the offset change has no effect on the path of the program."""
        return self.largest_distance_mm <= EQUALITY_TOLERANCE_MM


def compare_pictures(before: ProgramPicture, after: ProgramPicture) -> ComparedPaths:
    """Return two program pictures with the largest distance between their paths.

    The distance is in mm, or inf if the pictures do not contain the same moves.
    """
    if len(before.z) != len(after.z) or not np.array_equal(before.stroke, after.stroke):
        return ComparedPaths(before, after, float("inf"))
    if not len(before.z):
        return ComparedPaths(before, after)
    apart = np.hypot(after.z - before.z, after.x - before.x)
    return ComparedPaths(before, after, float(apart.max()))


@dataclass(slots=True)
class OffsetEffectWorker:
    """Worker that calculates the effect of an offset change.

    The screen reads only ``compared_paths``, ``compared_part``, ``is_busy`` and ``error_text``.
    """

    draw_path: DrawPaths
    compare_part: ComparePart | None = None  # None: parts cannot be compared.
    compared_paths: ComparedPaths | None = None
    compared_part: OffsetComparisonResult | None = None
    error_text: str = ""
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("effect"))

    @property
    def is_busy(self) -> bool:
        """Return whether the worker is still calculating.

        After an error, ``error_text`` contains the reason.
        """
        self.worker.deliver_results()
        return self.worker.is_busy

    def request_paths(self, job: Job, before: OffsetTables, after: OffsetTables) -> None:
        """Start calculating the paths of a program with the old and the new offsets.

        A calculation in progress is canceled.
        """

        def draw_both_paths(watch: ProgressCallback) -> ComparedPaths:
            return compare_pictures(
                *(self.draw_path(_with(job, each), before.tool_offsets, watch) for each in (before, after))
            )

        self.compared_paths, self.compared_part, self.error_text = None, None, ""
        self.worker.request_work(draw_both_paths, self._drawn, self._failed)

    def request_part(
        self, compare_part: ComparePart, job: Job, before: OffsetTables, after: OffsetTables
    ) -> None:
        """Start comparing the parts that a program makes with the old and the new offsets.

        A calculation in progress is canceled.
        """
        self.compared_part, self.error_text = None, ""
        work = partial(compare_part, _with(job, before), _with(job, after))
        self.worker.request_work(work, self._compared, self._failed)

    def _compared(self, part: OffsetComparisonResult | None) -> None:
        self.compared_part = part
        self.error_text = "" if part is not None else tr("THIS PROGRAM DOES NOT MAKE A PART")

    def _drawn(self, pair: ComparedPaths) -> None:
        self.compared_paths = pair

    def _failed(self, why: str) -> None:
        self.error_text = why

    def clear_results(self) -> None:
        """Cancel the calculation in progress, and discard the results."""
        self.worker.cancel_request()
        self.compared_paths, self.compared_part, self.error_text = None, None, ""

    def close(self) -> None:
        """Cancel the calculation in progress, and stop the worker."""
        self.worker.close()


def _with(job: Job, tables: OffsetTables) -> Job:
    return replace(
        job, setup=replace(job.setup, tools=tables.tool_offsets, secondary=tables.secondary_offsets)
    )


# --- display on the page -----------------------------------------------------------------------------------


@dataclass(slots=True)
class EffectDisplay:
    """Display of the effect of an offset change, with several views.

    F6 shows the views in this order: whole path, close-up of the largest change, part features, offset
    table.
    """

    offset_table: OffsetTable
    is_open: bool = False
    is_close_up_shown: bool = False  # Close-up of the largest change.
    is_part_shown: bool = False  # Effect on the features of the part.
    _asked: tuple[OffsetTables, OffsetTables] | None = None

    @property
    def offset_effect(self) -> OffsetEffectWorker | None:
        """Return the calculation of effects, or None if effects cannot be displayed."""
        return self.offset_table.desk.page_registry.find_model(OffsetEffectWorker)

    def show_next_view(self) -> None:
        """Show the next view of the effect (F6)."""
        if not self.is_open:
            self._open()
        elif self.is_part_shown or self.compared_paths is None or self.compared_paths.has_no_effect:
            self.close_view()
        elif not self.is_close_up_shown:
            self.is_close_up_shown = True
        else:
            self._open_part()

    def _open_part(self) -> None:
        effect, now = self.offset_effect, self.offset_table.desk.program_loader.loaded_program
        if effect is None or effect.compare_part is None or now.job is None or self._asked is None:
            self.close_view()
        elif now.picture is not None and now.picture.no_part:
            self.close_view()
            self.offset_table.desk.say(tr(now.picture.no_part))
        else:
            effect.request_part(effect.compare_part, now.job, *self._asked)
            self.is_part_shown = True

    def find_display_refusal(self) -> str:
        """Return the reason why no effect can be displayed now, or else an empty string.

        The result is also empty while an effect is displayed.
        """
        if self.is_open:
            return ""
        if self.offset_effect is None or self.offset_table.desk.program_loader.loaded_program.job is None:
            return tr("LOAD A PROGRAM FIRST TO SEE THE EFFECT ON ITS PATH")
        if self._make_tables_pair() is None:
            return tr("NO CHANGES YET. TYPE OR CHANGE A VALUE, THEN PRESS F6")
        return ""

    def _open(self) -> None:
        effect, job, pair = (
            self.offset_effect,
            self.offset_table.desk.program_loader.loaded_program.job,
            self._make_tables_pair(),
        )
        if effect is None or job is None or pair is None:
            self.offset_table.desk.say(self.find_display_refusal())
            return
        self.offset_table.desk.clear_prompt_line()
        effect.request_paths(job, *pair)
        self.is_open, self.is_close_up_shown, self.is_part_shown, self._asked = True, False, False, pair

    def _make_tables_pair(self) -> tuple[OffsetTables, OffsetTables] | None:
        """Return the old and new offsets, or None if there is no change to show.

        The change is the current entry if it changes a value, and otherwise the last change.
        """
        book, last = self.offset_table.offset_book, self.offset_table.offset_history.last_changes
        tools, secondary = self.offset_table.make_proposed_offsets()
        now = _tables(book.tool_offsets, book.secondary_offsets)
        typed = _tables(tools, secondary)
        if typed != now:
            return now, typed
        if not last:
            return None
        if self.offset_table.kind is OffsetKind.TOOL:
            return _tables(_restore_rows(book.tool_offsets, last, ToolOffsetRow), book.secondary_offsets), now
        return _tables(
            book.tool_offsets, _restore_rows(book.secondary_offsets, last, SecondaryOffsetRow)
        ), now

    def close_view(self) -> None:
        """Close the view of the effect, and show the offset table again."""
        self.is_open = self.is_close_up_shown = self.is_part_shown = False
        if self.offset_effect is not None:
            self.offset_effect.clear_results()

    @property
    def compared_paths(self) -> ComparedPaths | None:
        """Return the paths to draw, or None if the view is closed or the paths are not available yet."""
        effect = self.offset_effect
        return None if not self.is_open or effect is None or effect.is_busy else effect.compared_paths

    @property
    def compared_part(self) -> OffsetComparisonResult | None:
        """Return the comparison of the parts that result from the old and the new offsets.

        The result is None if this view is not shown or the comparison is not available yet.
        """
        effect = self.offset_effect
        return None if not self.is_part_shown or effect is None or effect.is_busy else effect.compared_part

    def _words_of_part(self, effect: OffsetEffectWorker) -> str:
        part = self.compared_part
        if effect.error_text:
            return tr(
                Message(
                    "PARTS WITH OLD AND NEW OFFSETS CANNOT BE COMPARED: {why}. F6: SHOW TABLE",
                    why=effect.error_text,
                )
            )
        if part is None:
            return tr("SIMULATING THE PART WITH OLD AND NEW OFFSETS")
        if not part.differing_feature_count:
            return tr("NO DIAMETER OR SHOULDER ON THE PART CHANGES. F6: SHOW TABLE")
        if part.differing_feature_count == 1:
            return tr("1 PART FEATURE WILL CHANGE. F6: SHOW TABLE")
        words = tr("{count} PART FEATURES WILL CHANGE. F6: SHOW TABLE")
        return tr(Message(words, count=part.differing_feature_count))

    @property
    def words(self) -> str:
        """Return the prompt text that describes the displayed view."""
        effect = self.offset_effect
        return (
            self._words_of_part(effect)
            if self.is_part_shown and effect is not None
            else self._words_of_path()
        )

    def _words_of_path(self) -> str:
        effect, pair = self.offset_effect, self.compared_paths
        if effect is not None and effect.error_text:
            return tr(Message("THE EFFECT CANNOT BE DRAWN: {why}", why=effect.error_text))
        if pair is None:
            return tr("DRAWING THE OLD AND NEW PATHS")
        if pair.has_no_effect:
            return tr("THE CHANGE DOES NOT AFFECT THE LOADED PROGRAM. F6: SHOW TABLE")
        mode = self.offset_table.unit_mode
        if pair.largest_distance_mm == float("inf"):
            return tr("THE TWO PATHS HAVE DIFFERENT MOVES. F6: SHOW TABLE")
        far = f"{format_length(pair.largest_distance_mm, mode.is_metric)} {mode.name}"
        if not self.is_close_up_shown:
            text = tr("PATHS DIFFER BY {far} (CIRCLED). F6: CLOSE-UP   ESC: TABLE")
            return tr(Message(text, far=far))
        text = tr("PATHS DIFFER BY UP TO {far}. Z: ZOOM   F6: SHOW TABLE")
        if effect is not None and effect.compare_part is not None:
            text = tr("PATHS DIFFER BY UP TO {far}. Z: ZOOM   F6: EFFECT ON THE PART")
        return tr(Message(text, far=far))


def _tables(tools: Mapping[int, ToolOffsetRow], secondary: Mapping[int, SecondaryOffsetRow]) -> OffsetTables:
    return OffsetTables(make_tool_offsets(tools), make_secondary_offsets(secondary))


def _restore_rows(
    rows: Mapping[int, OffsetRowT], changes: tuple[OffsetChange, ...], kind: type[OffsetRowT]
) -> dict[int, OffsetRowT]:
    """Return the offset rows as they were before the given changes."""
    undone = dict(rows)
    for change in changes:
        undone.pop(change.number, None)
        if isinstance(change.old, kind):
            undone[change.number] = change.old
    return undone
