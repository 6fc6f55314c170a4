"""Codes of program flow, machine functions and plane switching."""

from __future__ import annotations

from functools import partial

from core.interpreter.omniturn.codes.code_entry import (
    Acts,
    Chapter,
    Code,
    FWord,
    Refusal,
    When,
    WordRule,
    flow,
    letter,
    m_code,
    names,
)

# fmt: off
_plane = partial(
    Code, acts=Acts.FLOW, f=FWord.NONE, handler="motion.plane_switching:plane_line",
    not_in_mdi=
                "{code} cannot be used in MDI, because plane switching needs more than one line.",
    not_when={
        When.C_FREE: Refusal(
            "c-unlocked",
            "(~{name}) rotates the C axis, but the spindle is not locked as the C axis.",
            "Write M19 before the (~PLXC) or (~PLZC) line.", 1),
        When.PER_REV: Refusal(
            "plane-feed-mode",
            "(~{name}) needs a feed in inches per minute, but G95 is active.",
            "Write G94 with F before the (~PLXC) or (~PLZC) line.", 1),
        When.NOSE_COMPENSATION: Refusal(
            "plane-nose-comp",
            "(~{name}) cannot run while nose compensation is active.",
            "Write G40 before the (~PLXC) or (~PLZC) line.", 1),
        When.TOOL_NOT_MOVED: Refusal(
            "tool-first-move",
            "No X and Z move is programmed after the T word on line {line}.",
            "Program a move to X and Z before the (~PLXC) or (~PLZC) line.", 1),
    },
)
_PLANE = names("arc-radius feed-missing feed-range plane-open plane-side plane-sign plane-word")
FLOW_CHAPTERS: tuple[Chapter, ...] = (
    ("Program flow", (
        flow("LS", "LSn",
        "Repeats the following lines n times, up to the line with LF.", "LS3\nG91\nZ-.1\nG90\nLF",
            handler="flow.loops_and_subroutines:Flow.steer", words=names("LS"), deletable=False,
            not_in_mdi=
                "{code} cannot start a loop in MDI; a loop needs more than one line, with LF at the end.",
            further=names("loop-open word-missing")),
        flow("LF", "LF", "Ends a loop.", "LS2\nX.55\nX.6\nLF",
            handler="flow.loops_and_subroutines:Flow.steer", words=names("LF"), deletable=False,
            not_in_mdi=
                "{code} ends a loop, but no loop was started.", further=names("loop-unopened")),
        flow("P", "Pn", "Runs subroutine n.", "P4", "}4\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.call", words=names("P"), calls=True,
            not_in_mdi=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            further=names("recursion subroutine-missing")),
        flow("}", "}n",
        "Marks the start of subroutine n; subroutines are written after the end of the program.",
        "M98P5", "}5\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.steer", words=names("}"), deletable=False,
            not_in_mdi=
                "{code} cannot define a subroutine in MDI; subroutines are possible only in a program.",
            further=names("subroutine-open subroutine-twice word-missing")),
        flow("M98", "M98Pn", "Runs subroutine n.", "M98P2", "}2\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.call", words=names("P M"), calls=True,
            not_in_mdi=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            further=names("recursion subroutine-missing")),
        flow("M99", "M99", "Ends a subroutine.", "M98P3", "}3\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.steer", words=names("M"), deletable=False,
            not_in_mdi=
                "{code} ends a subroutine, but no subroutine was started.", further=names("m99-outside")),
        flow("M95", "M95",
        "Runs subroutine 1 if TB2-9 is closed.", "M95", "}1\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.call", words=names("M"), terminal=("TB2-9",
            True), calls=True,
            asks=True, not_in_mdi=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            further=names("recursion subroutine-missing")),
        flow("M97", "M97InCnPn",
        "Runs subroutine P if input I is on (with C1) or off (with C0).", "M97I10C1P6",
            "}6\nX.55\nM99\n", handler="flow.loops_and_subroutines:Flow.call", words=names("C I P M"),
            calls=True, asks=True, not_in_mdi=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            rules={
                "C": WordRule(
                "required state of the input, on (1) or off (0)", least=0, most=1, whole=True, wrong=Refusal(
                    "condition",
                    "The line contains {word}, which is neither C1 (on) nor C0 (off).",
                    "Write C1 or C0.")),
                    "I": WordRule("the number of the input", least=1, whole=True, wrong=Refusal(
                    "input-number",
                    "The line contains {word}, which is not an input number.",
                    "Write the number of the input.")),
            },
            further=names("recursion subroutine-missing")),
        m_code("M91", "M91", "Waits until TB2-5 is open.", "M91",
            acts=Acts.START, handler="setup.m_codes:wait_for_input", terminal=("TB2-5", False)),
        m_code("M92", "M92", "Waits until TB2-5 is closed.", "M92",
            acts=Acts.START, handler="setup.m_codes:wait_for_input", terminal=("TB2-5", True)),
        m_code("M93", "M93", "Waits until TB2-7 is open.", "M93",
            acts=Acts.START, handler="setup.m_codes:wait_for_input", terminal=("TB2-7", False)),
        m_code("M94", "M94", "Waits until TB2-7 is closed.", "M94",
            acts=Acts.START, handler="setup.m_codes:wait_for_input", terminal=("TB2-7", True)),
        m_code("M00", "M00", "Stops the program; the comment shows the operator what to do.",
            "M00(TURN THE PART AROUND)", acts=Acts.STOP, handler="setup.m_codes:program_stop"),
        m_code("M01", "M01", "Stops the program if Optional Stop is on.", "M01(CHECK THE TOOL)",
            acts=Acts.STOP, handler="setup.m_codes:program_stop"),
        m_code("M02", "M02",
        "Ends the program without changing the M functions.", "/M02",
            acts=Acts.STOP, handler="setup.m_codes:program_end", ends_program=True,
            further=names("after-end no-end")),
        m_code("M30", "M30",
        "Ends the program and turns the M functions off. With Cycle Repeat on, the "
        "program repeats.", "/M30",
            acts=Acts.STOP, handler="setup.m_codes:program_end", ends_program=True,
            further=names("after-end no-end")),
        m_code("M31", "M31", "Turns Cycle Repeat off.", "M31",
            acts=Acts.STOP, handler="setup.m_codes:repeat_off"),
        letter("/", "/",
        "At the start of a line, skips the line while Block Delete is on.", "/X.55",
            handler="omniturn_statement:statement_of"),
        letter("()", "(text)",
        "Comment. The screen shows it to the operator from this line on.", "X.55(WATCH THE CHUCK)",
            handler="omniturn_statement:statement_of"),
    )),
    ("Machine functions", (
        m_code("M08", "M08", "Turns the coolant on.", "M08", acts=Acts.START,
        handler="setup.m_codes:coolant"),
        m_code("M09", "M09", "Turns the coolant off.", "M09", acts=Acts.STOP,
        handler="setup.m_codes:coolant"),
        m_code("M12", "M12", "Clamps the collet.", "M12", acts=Acts.START, handler="setup.m_codes:collet"),
        m_code("M13", "M13", "Unclamps the collet.", "M13\nG04F.5\nM12",
            acts=Acts.START, handler="setup.m_codes:collet", not_when={When.TURNING: Refusal(
                "unclamp-turning", "M13 opens the collet while the spindle turns.",
                "Stop the spindle with M05 first.", "M")}),
    )),
    ("Plane switching", (
        _plane("~PLXC", "(~PLXC) … (END)",
        "Mills the face: program X and Y across the face; the machine moves X and C.",
            "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLXC)\n(X.25Y0)\n(X.25Y.2)\n(END)\nM28\nM05",
            further=_PLANE | names("plane-centre plane-h-late plane-reach")),
        _plane("~PLZC", "(~PLZC) … (END)",
        "Mills the side: program X along the part and Y around it; the machine moves Z and C.",
            "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLZC)\n(D1.)\n(X.25Y.2)\n(X.5Y0)\n(END)\nM28\nM05",
            further=_PLANE | names("plane-d-late plane-diameter")),
    )),
)
# fmt: on
