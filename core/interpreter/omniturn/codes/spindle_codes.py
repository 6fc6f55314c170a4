"""Codes of the spindle, and of the spindle as the axis C."""

from __future__ import annotations

from functools import partial

from core.interpreter.omniturn.codes.code_entry import (
    PLAIN_WORDS,
    Acts,
    Chapter,
    Code,
    FWord,
    Limit,
    Refusal,
    SWord,
    Together,
    When,
    WordRule,
    letter,
    m_code,
    mode,
    names,
)

# fmt: off
_SLOWLY = "M05\nG94F30"  # before the spindle is made an axis
_start = partial(
    Code, acts=Acts.SPINDLE, handler="setup.spindle_speed:run_block", words=PLAIN_WORDS, f=FWord.FEED,
    not_when={
        When.C_LOCKED: Refusal(
            "spindle-locked",
            "M{number} starts the spindle, but the spindle is locked as the C axis.",
            "Release the spindle with M05 first.", "M"),
        When.NO_SPEED: Refusal(
            "speed-missing",
            "M{number} starts the spindle, but no spindle speed S is programmed.",
            "Write S on this line.", "M"),
        When.COLLET_OPEN: Refusal(
            "collet-open", "M{number} starts the spindle with the collet open.",
            "Close the collet with M12 first.", "M"),
    },
)
_SPEED_SIGN = Refusal(
    "speed-sign",
    "{word}: spindle speed cannot be negative; M03 and M04 set the direction.", "Remove the sign."
)
_SPEED_LIMIT = WordRule(
    "rpm", least=0,
    missing=Refusal("word-missing", "G{number} needs S, a speed in rpm.",
    "Write G{number}S with a speed in rpm.", "S"),
    wrong=Refusal("word-missing", "G{number} needs S, a speed in rpm.",
    "Write G{number}S with a speed in rpm.", "S"),
)
_C_SPEED = WordRule(
            "C axis speed in rpm, without a sign", least=0, over=True, most=Limit.C_RPM,
    wrong=Refusal("speed-range",
    "{word}: the C axis speed must be above 0 and at most {most} rpm.", "Correct S."),
)
_NO_C = Refusal(
    "c-disabled",
    "{name} needs a C axis, but the C axis is disabled in the machine file.",
            "Enable the C axis (axis.C.enabled)."
)
_ANGLE = WordRule(
    "angle in degrees; absolute (like CA) under G90, incremental (like CI) under G91",
    numberless=Refusal("number-missing", "{word} has no number.", "Write the angle in degrees."),
)
_c_word = partial(
    Code, acts=Acts.WORD, f=FWord.NONE, handler="motion.c_axis:c_move",
    apart=(Together(("C", "CA", "CI"), Refusal(
        "word-twice",
        "The line contains both {first} and {word}.", "Keep only one of the conflicting words.")),),
    not_when={When.C_FREE: Refusal(
        "c-unlocked",
        "{word} rotates the C axis, but the spindle is not locked as the C axis.",
            "Write M19 or M89 before this line.")},
    further=names("c-too-little feed-over-speed finer-than-step speed-missing"),
)
SPINDLE_CHAPTERS: tuple[Chapter, ...] = (
    ("Spindle and C axis", (
        letter("S", "Sn", "Spindle speed in rpm with G97, surface speed in ft/min with G96.", "S1500",
            handler="setup.spindle_speed:speed_word", words=names("S"),
            rules={"S": WordRule(
                "rpm", least=0, most=Limit.RPM, wrong=_SPEED_SIGN,
                too_great=Refusal(
                    "speed-range",
                    "{word} is above the spindle maximum of {most} rpm.", "Lower S."))}),
        _start("M03", "M03Sn", "Spindle forward.", "M03S1200"),
        _start("M04", "M04Sn", "Spindle reverse.", "M04S800\nG04F2"),
        m_code("M05", "M05",
        "Turns the spindle off; the S value is retained.", "M05",
            acts=Acts.STOP, handler="setup.spindle_speed:stop_block"),
        mode("G96", "G96Sn", "Constant surface speed in ft/min; the rpm changes with the radius.",
            "G96S200\nX.3\nG97S1000", handler="setup.spindle_speed:spindle_modes", group="spindle mode",
            rules={"S": WordRule(
                "surface speed in ft/min, or in m/min with G71",
                least=0, most=Limit.SURFACE, wrong=_SPEED_SIGN,
                too_great=Refusal(
                    "speed-range",
                    "{word}: this surface speed is too high for any tool.", "Write G97 if S is in rpm."))},
            further=names("surface-speed-missing")),
        mode("G97", "G97Sn", "S is in rpm again.", "G97S900",
            handler="setup.spindle_speed:spindle_modes", group="spindle mode"),
        mode("G76", "G76Sn", "Minimum rpm under G96.", "G96S200\nG76S300\nX.3\nG97S1000",
            handler="setup.spindle_speed:spindle_modes", group="speed limits", s=SWord.LIMIT,
            rules={"S": _SPEED_LIMIT}, further=names("speed-limits")),
        mode("G77", "G77Sn", "Maximum rpm under G96.", "G96S200\nG77S2000\nX.1\nG97S1000",
            handler="setup.spindle_speed:spindle_modes", group="speed limits", s=SWord.LIMIT,
            rules={"S": _SPEED_LIMIT}, further=names("speed-limits")),
        Code("G89", "G89",
        "Stops the spindle and locks it in place, like M89.",
            f"{_SLOWLY}\nG89\nCI90S60\nG04F2\nM05", acts=Acts.LOCK, handler="motion.c_axis:lock",
            words=names("S"),
            f=FWord.NONE, s=SWord.C_SPEED, before_corner=True, rules={"S": _C_SPEED},
            not_when={When.NO_C: _NO_C, When.WITH_M: Refusal(
                "not-alone",
                "G89 locks the spindle and cannot be combined with M codes.", "Split the line.")}),
        m_code("M19", "M19Sn",
        "Turns the spindle to angle 0 and locks it until M05.",
            f"{_SLOWLY}\nM19S60\nG04F3\nM05", acts=Acts.LOCK, handler="motion.c_axis:lock", s=SWord.C_SPEED,
            rules={"S": _C_SPEED}, not_when={When.NO_C: _NO_C}),
        m_code("M89", "M89",
        "Stops the spindle and locks it in place.",
            f"{_SLOWLY}\nM89\nCI45S60\nG04F2\nM05", acts=Acts.LOCK, handler="motion.c_axis:lock",
            s=SWord.C_SPEED,
            rules={"S": _C_SPEED}, not_when={When.NO_C: _NO_C}),
        _c_word("CA", "CAn", "Turns the spindle to angle n.",
            f"{_SLOWLY}\nM19S60\nG04F3\nCA90S60\nG04F2\nM05",
            rules={"C": _ANGLE, "S": _C_SPEED}),
        _c_word("CI", "CIn",
        "Turns the spindle by n degrees; the sign sets the direction.",
            f"{_SLOWLY}\nM89\nCI-30S60\nG04F2\nM05", rules={"C": _ANGLE, "S": _C_SPEED}),
    )),
)
# fmt: on
