"""What a proposed correction does, before it is taken over: to the measured feature and to the whole part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from app.desk.desk import Desk
from app.desk.pages.sheet import Sheet
from app.desk.translation import tr
from app.extras.quality.plots import ChartDrawing, correction_plot
from app.extras.quality.section import signed_size
from app.extras.quality.wear_correction import Correction
from app.offsets.offset_effect import Effect, Tables
from app.offsets.offset_values import Mode
from app.offsets.offsets_in_force import secondary_offsets, tool_offsets
from app.offsets.part_effect import part_table
from core.extras.quality.wear_proposal import Proposal
from core.message import Message
from core.store.store_rows import Kind, SecondaryRow, ToolRow

SHOWN = 25  # newest readings that are drawn


@dataclass(slots=True)
class CorrectionEffect:
    """Stands as long as the question does. The part is made both ways on the worker of the offset pages."""

    desk: Desk
    question: str = ""
    found: Proposal | None = None
    _readings: tuple[tuple[int, float], ...] = ()  # part and size, mm
    _drawn: tuple[object, ChartDrawing] = field(default=(None, ChartDrawing()))

    @property
    def stands(self) -> bool:
        """Whether its question is still the one on the prompt line."""
        return bool(self.question) and self.desk.notice == self.question

    def show(
        self, question: str, found: Proposal, change: Correction, readings: tuple[tuple[int, float], ...]
    ) -> None:
        """From now on; the worker makes the part before and after."""
        again = (question, found, readings) == (self.question, self.found, self._readings)
        self.question, self.found, self._readings = question, found, readings
        effect, job = self._effect, self.desk.session.now.job
        if effect is not None and effect.compare is not None and job is not None and not again:
            effect.ask_part(effect.compare, job, *self._tables(change))

    @property
    def _effect(self) -> Effect | None:
        return self.desk.attached(Effect)

    def _tables(self, change: Correction) -> tuple[Tables, Tables]:
        book = self.desk.book
        tools: dict[int, ToolRow] = dict(book.tools)
        secondary: dict[int, SecondaryRow] = dict(book.secondary)
        before = Tables(tool_offsets(tools), secondary_offsets(secondary))
        values: Mapping[str, Any] = change.values
        if change.kind is Kind.TOOL:
            tools[change.number] = tools[change.number]._replace(**values)
        else:
            secondary[change.number] = secondary.get(change.number, SecondaryRow())._replace(**values)
        return before, Tables(tool_offsets(tools), secondary_offsets(secondary))

    def sheet(self, mode: Mode) -> Sheet | None:
        """Every diameter and shoulder before and after; None where no part can be made of the program."""
        effect = self._effect
        if effect is None or effect.busy or effect.trouble or effect.part is None:
            return None
        return part_table(effect.part, mode)

    def words(self) -> str:
        """How it stands with the part."""
        effect = self._effect
        if effect is None or effect.compare is None or self.desk.session.now.job is None:
            return ""
        if effect.busy:
            return tr("SIMULATING THE PART WITH OLD AND NEW OFFSETS")
        return (
            tr(Message("PARTS WITH OLD AND NEW OFFSETS CANNOT BE COMPARED: {why}", why=effect.trouble))
            if effect.trouble
            else ""
        )

    def drawing(self, mode: Mode) -> ChartDrawing:
        """The readings between their limits, their mean, and what the next parts will measure."""
        found = self.found
        if found is None or not self._readings:
            return ChartDrawing()
        of = (self.question, self._readings, mode)
        if self._drawn[0] != of:
            change = signed_size(found.expected - found.mean, mode)
            title = tr(Message("{name}: {change} FROM NEXT PART", name=found.feature.name, change=change))
            newest = self._readings[-SHOWN:]
            plot = correction_plot(newest, found, title, (tr("NOW"), tr("AFTER")), mode.unit)
            self._drawn = of, ChartDrawing((plot,), of)
        return self._drawn[1]
