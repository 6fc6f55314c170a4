"""Steps of the tour: captions, key presses and the conditions that end the steps.

The tour makes a part, corrects wear, and shows a program whose rapid would hit the part.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path

FILES_FOLDER = Path(__file__).with_name("files")
PROGRAM_PATH, TOOLS_PATH = FILES_FOLDER / "tour.nc", FILES_FOLDER / "tools.toml"
PROGRAM_NAME, FAULTY_PROGRAM_NAME = "tour.nc", "tour-wrong-sign.nc"
STOCK, STICK_OUT_IN = "bar:1.0", 1.5  # stock of both programs, and its length outside the collet
RIGHT_WORD, WRONG_WORD = "Z.05(CLEAR", "Z-.05(CLEAR"

PALMS_DOWN, PALMS_UP = "PalmsDown", "PalmsUp"  # Both palm buttons, which start the cycle.
SOLID_VIEW = "SolidView"  # The keys that select the picture of the part in space.


class StepEnd(Enum):
    """Condition that ends a step of the tour after its keys were pressed and its time is over."""

    TIME = auto()  # No other condition.
    PROVED = auto()  # The program of the step is proved and can start.
    READY = auto()  # The drives are on.
    TOOL = auto()  # The program has called the tool of the step.
    FINISHED = auto()  # The program has ended, and the part is counted.
    CORRECTED = auto()  # The wear correction is saved.
    PATHS_COMPARED = auto()  # The paths with the old and the new offset are drawn.
    PARTS_COMPARED = auto()  # The diameters with the old and the new offset are calculated.
    REJECTED = auto()  # The proof of the step's program has found an error.


@dataclass(frozen=True, slots=True)
class TourStep:
    """One step of the tour.

    ``keys`` are pressed one after another when the step begins. ``seconds`` is the minimum duration, so
    that the caption can be read. ``program`` is the name of the program that the step loads. ``tool`` is
    the tool that ends a step with the condition ``StepEnd.TOOL``.
    """

    caption: str
    keys: tuple[str, ...] = ()
    end: StepEnd = StepEnd.TIME
    seconds: float = 0.0
    program: str = ""
    tool: int = 0


TOUR_STEPS = (
    TourStep(
        "TURNDESK PROVES THE PROGRAM BEFORE THE FIRST MOVE",
        end=StepEnd.PROVED,
        seconds=1.0,
        program=PROGRAM_NAME,
    ),
    TourStep("DRIVES ON. THEN BOTH PALM BUTTONS START THE CYCLE", (SOLID_VIEW, "D"), StepEnd.READY),
    TourStep(
        "TURNING: A BRASS BAR IS FACED, ROUGHED AND FINISHED",
        (PALMS_DOWN, PALMS_UP),
        StepEnd.TOOL,
        tool=11,
    ),
    TourStep("THREADING: EACH PASS STARTS AT THE SAME SPINDLE ANGLE", end=StepEnd.TOOL, tool=12),
    TourStep("MILLING: THE SPINDLE IS NOW THE C AXIS AND A MILL CUTS A HEXAGON", end=StepEnd.TOOL, tool=3),
    TourStep("PARTING OFF: THE PART FALLS INTO THE CATCHER", end=StepEnd.FINISHED),
    TourStep("WEAR: THE HEAD MEASURES .8612 IN INSTEAD OF .8600 IN", ("F9", "1", "Enter"), seconds=3.0),
    TourStep(
        "WEAR: D1 MAKES THE DIAMETER .0012 IN SMALLER",
        (*"-.0012", "Enter", "Enter", "Enter"),
        StepEnd.CORRECTED,
        seconds=4.0,
    ),
    TourStep("THE PATH BEFORE AND AFTER THE CORRECTION", ("F6",), StepEnd.PATHS_COMPARED, seconds=1.5),
    TourStep("TURNDESK CALCULATES THE PART WITH THE CORRECTION", ("F6", "F6"), StepEnd.PARTS_COMPARED),
    TourStep("EVERY DIAMETER CUT WITH D1 GETS .0012 IN SMALLER", seconds=5.0),
    TourStep(
        "A WRONG SIGN: LINE {line} SAYS Z-.05 INSTEAD OF Z.05",
        ("Esc", "Esc"),
        StepEnd.REJECTED,
        seconds=3.0,
        program=FAULTY_PROGRAM_NAME,
    ),
    TourStep("CRASH FOUND BEFORE IT HAPPENS: THE START IS REJECTED", (PALMS_DOWN, PALMS_UP), seconds=4.5),
    TourStep("END OF THE TOUR. SEE IT AGAIN WITH F10, TOUR", seconds=3.0),
)


def read_programs() -> dict[str, str]:
    """Return the program of the tour and its copy with a wrong sign, by name. Raises OSError."""
    text = PROGRAM_PATH.read_text(encoding="ascii")
    return {PROGRAM_NAME: text, FAULTY_PROGRAM_NAME: text.replace(RIGHT_WORD, WRONG_WORD)}


def find_wrong_line(text: str) -> int:
    """Return the number of the line with the wrong sign, or 0 if no line has it."""
    lines = enumerate(text.splitlines(), 1)
    return next((number for number, line in lines if WRONG_WORD in line), 0)
