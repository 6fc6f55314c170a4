"""The pages of the main window: names, the keys that open them, and what they are for. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

MENU, AUTOMATIC, EDITOR, MDI, JOG = "MAIN MENU", "AUTOMATIC", "EDITOR", "MDI", "JOG"
SEARCHTO = "SEARCHTO"
TOOLS, SECCMP, SPECIAL = "TOOL OFFSETS", "SECONDARY OFFSETS", "SPECIAL FUNCTIONS"
PROGRAMS, ZERO = "PROGRAMS", "ZERO OFFSETS"


@dataclass(frozen=True, slots=True)
class Entry:
    """One line of the main menu: the key there, the label of that key, the page and its use."""

    key: str
    label: str
    name: str
    use: str


ENTRIES = (
    Entry("F2", "AUTO", AUTOMATIC, "run programs"),
    Entry("F3", "EDIT", EDITOR, "write and prove programs"),
    Entry("F4", "MDI", MDI, "one line at a time"),
    Entry("F5", "JOG", JOG, "move by hand, touch tools off"),
    Entry("F6", "LIST", PROGRAMS, "list, preview, copy, import and export"),
    Entry("F8", "TOOLS", TOOLS, "T1…T32: position and nose radius"),
    Entry("F9", "SECCMP", SECCMP, "D1…D32: corrections of wear and size"),
    Entry("G", "ZERO", ZERO, "G54…G59: where SINUMERIK programs have their zero"),
    Entry("F10", "SPECIAL", SPECIAL, "speed limit, parts, inputs and outputs, log, backup"),
)
