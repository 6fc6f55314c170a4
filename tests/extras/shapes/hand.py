"""A programmer at the forms: every key counts; and the proof of what they write."""

from __future__ import annotations

from functools import cache

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.extras.shapes.shapes_model import ShapesModel
from core.extras.shapes.shape_fields import ShopData
from core.interpreter.shared.job_setup import InterpreterSetup, SecondaryOffset, ToolOffset
from core.language.diagnostics import Severity
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.part.stock_spec import parse_stock_specification
from core.part.tool_shape import ToolShape
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.proof_report import PartReport, ProofReport

_NAMED = {"⏎": "Enter", "↓": "Down", "↑": "Up", "→": "Right", "←": "Left", "⌫": "Back"}


@cache
def machine() -> Machine:
    """The machine that is shipped."""
    return load_machine(None)


class Programmer:
    """At the shapes of an empty program. ``strokes`` counts keys as a person strikes them."""

    def __init__(self, tools: dict[int, ToolShape] | None = None, text: str = "") -> None:
        self.shop = ShopData(max_acceleration_mm_s2=3048.0, tools=tools or {})
        self.shapes = ShapesModel(shop_data=self.shop)
        self.strokes = 0
        self.open(text)

    def open(self, text: str = "", line: int = 1) -> str:
        """Shift+F3 in the editor: two keys."""
        self.strokes += 2
        self.shapes.read_shop_data = lambda: self.shop
        said = self.shapes.open_program_text("x.nc", text, line)
        self.shapes.worker.wait_for_results(60.0)
        return said

    def strike(self, keys: str) -> Programmer:
        """Keys: characters, arrows, ``⏎``; ``§`` is F2."""
        for key in keys:
            self.strokes += 1
            if key == "§":
                self.shapes.write_form()
            else:
                assert self.shapes.handle_key(_NAMED.get(key, key)), (key, keys, self.shapes.prompt_text())
        return self

    def close(self) -> str:
        """The text, as it stands in the editor."""
        assert self.shapes.form is None, self.shapes.prompt_text()
        self.shapes.close()
        return self.shapes.text

    @property
    def word(self) -> str:
        """Of the marked field."""
        assert self.shapes.form is not None
        return self.shapes.form.selected_field_name

    @property
    def troubles(self) -> dict[str, str]:
        """What the form refuses, by field."""
        assert self.shapes.form is not None
        return self.shapes.form.error_texts


def setup_of(offsets: dict[int, SecondaryOffset] | None = None, *, strict: bool = False) -> InterpreterSetup:
    """All tools are touched off at one place."""
    places = {n: ToolOffset(12.7, -76.2) for n in range(1, 33)}
    return create_power_up_setup(
        machine(), tool_offsets=places, secondary_offsets=offsets or {}, is_strict=strict
    )


def proved(
    text: str,
    tools: dict[int, ToolShape] | None = None,
    offsets: dict[int, SecondaryOffset] | None = None,
    stock: str = "",
) -> tuple[ProofReport, PartReport]:
    """The program and its part on the shipped machine, as the desk proves them, notes as errors too."""
    setting = PartSettings(stock=parse_stock_specification(stock) if stock else None, shapes=tools or {})
    report, part = prove_program_and_part(
        ProgramSource("x.nc", text), setup_of(offsets, strict=True), machine(), setting
    )
    assert part is not None
    return report, part


def bad(report: ProofReport) -> list[str]:
    """Everything that would keep it from running, or that ought to be looked at."""
    return [d.format_one_line("x.nc") for d in report.diagnostics if d.severity is not Severity.NOTE]
