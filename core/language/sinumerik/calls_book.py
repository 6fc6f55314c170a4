"""The code book of SINUMERIK: subprograms with parameters, repeats, and lines that are taken."""

from __future__ import annotations

from core.language.code_book import Entry

_DEPTH = (("STEP.spf", "PROC STEP(REAL DEPTH, INT TIMES=2)\nG0 Z=DEPTH*TIMES\nM17\n"),)
_TAKEN = "Accepted, but the program listing still shows every block."

CALLS = (
    Entry(
        "PROC", "NAME(REAL LENGTH, VAR INT COUNT, REAL MORE=1) SAVE",
        (

                "First line of a subprogram, with its parameters: VAR returns the value to the "
                "caller, and = sets the value that is used if the caller does not pass a "
                "value. VAR REAL LIST[3] accepts an array of that size, and VAR REAL LIST[] an "
                "array of any size. SAVE restores the G functions and the frame at the end."),
        "STEP(-3)\nSTEP(-2, 4)", "STEP(1, 2, 3)", "12330", files=_DEPTH,
    ),
    Entry(
        "EXTERN", "NAME(REAL, INT)", (
            "Declares a subprogram that has parameters and is stored in a separate file."),
        "EXTERN STEP(REAL, INT)\nSTEP(-3)", "EXTERN 5", "EXTERN", files=_DEPTH,
    ),
    Entry(
        "MCALL", "NAME(…)", (

                "Calls a subprogram or a cycle after each block that moves an axis; MCALL "
                "without a name ends these calls."),
        "MCALL STEP(-3)\nX50\nMCALL", "MCALL NOWHERE\nX50", "NOWHERE", files=_DEPTH,
    ),
    Entry("CALL", '"NAME"', "Calls a subprogram by its name.", 'CALL "STEP"', "CALL", "CALL", files=_DEPTH),
    Entry(
        "REPEATB", "LABEL P=2", (
            "Repeats the block that has the label."),
        "AGAIN: Z=IC(-1)\nREPEATB AGAIN P=2", "REPEATB NOWHERE", "14080",
    ),
    Entry(
        "CASE", "R1 OF 1 GOTOF LABEL DEFAULT GOTOF OTHER", (
            "Jumps to one of several labels, depending on a value."),
        "R1=2\nCASE R1 OF 1 GOTOF ONE DEFAULT GOTOF OTHER\nONE: Z5\nOTHER:",
        "CASE 1 GOTOF ONE", "CASE needs OF",
    ),
    Entry("GOTOS", "", "Jumps to the first block.", "R1=1\nIF R1==2 GOTOS", "GOTOS X3", "GOTOS"),
    Entry(
        "SETAL", "(65000)", (
            "Raises an alarm; a program that reaches this block is rejected."),
        "R1=1\nIF R1==2\nSETAL(65000)\nENDIF", "SETAL(65000)", "65000",
    ),
    *(
        Entry(word, "", _TAKEN, word, f"{word} X3", word)
        for word in ("DISPLOF", "DISPLON", "SBLOF", "SBLON")
    ),
    Entry("GROUP_BEGIN", '(0,"ROUGH",0,0)', (
            "Start of a group of blocks in the editor of the original control; accepted without " "effect."),
          'GROUP_BEGIN(0,"ROUGH",0,0)\nX40\nGROUP_END(0,0)', "GROUP_BEGIN X3", "GROUP_BEGIN"),
    Entry("GROUP_END", "(0,0)", "End of a group of blocks.", "GROUP_END(0,0)", "GROUP_END X3", "GROUP_END"),
)  # fmt: skip
"""What is written where a program calls others, or steers itself by name."""
