"""Codes of program flow, machine functions and coordinate transformation (plane switching)."""

from __future__ import annotations

from functools import partial

from core.interpreter.omniturn.codes.code_entry import (
    ActionKind,
    Chapter,
    CodeEntry,
    ErrorTemplate,
    FMeaning,
    RejectionCondition,
    WordRule,
    make_flow_entry,
    make_letter_entry,
    make_m_code_entry,
    names,
)

# fmt: off
_plane = partial(
    CodeEntry, action_kind=ActionKind.FLOW, f_meaning=FMeaning.NONE,
        handler="motion.plane_switching:execute_plane_line",
    mdi_error_text=
                "{code} cannot be used in MDI, because plane switching needs more than one line.",
    rejection_conditions={
        RejectionCondition.C_NOT_LOCKED: ErrorTemplate(
            "c-unlocked",
            "(~{name}) rotates the C axis, but the spindle is not locked as the C axis.",
            "Write M19 before the (~PLXC) or (~PLZC) line.", 1),
        RejectionCondition.FEED_PER_REV: ErrorTemplate(
            "plane-feed-mode",
            "(~{name}) needs a feed in inches per minute, but G95 is active.",
            "Write G94 with F before the (~PLXC) or (~PLZC) line.", 1),
        RejectionCondition.NOSE_COMPENSATION: ErrorTemplate(
            "plane-nose-comp",
            "(~{name}) cannot run while nose compensation is active.",
            "Write G40 before the (~PLXC) or (~PLZC) line.", 1),
        RejectionCondition.TOOL_NOT_MOVED: ErrorTemplate(
            "tool-first-move",
            "No X and Z move is programmed after the T word on line {line}.",
            "Program a move to X and Z before the (~PLXC) or (~PLZC) line.", 1),
    },
)
_PLANE = names("arc-radius feed-missing feed-range plane-open plane-side plane-sign plane-word")
FLOW_CHAPTERS: tuple[Chapter, ...] = (
    ("Program flow", (
        make_flow_entry("LS", "LSn",
        "Repeats the following lines n times, up to the line with LF.", "LS3\nG91\nZ-.1\nG90\nLF",
            handler="flow.loops_and_subroutines:Flow.execute_flow_line", allowed_words=names("LS"),
            allows_block_delete=False,
            mdi_error_text=
                "{code} cannot start a loop in MDI; a loop needs more than one line, with LF at the end.",
            other_diagnostic_codes=names("loop-open word-missing")),
        make_flow_entry("LF", "LF", "Ends a loop.", "LS2\nX.55\nX.6\nLF",
            handler="flow.loops_and_subroutines:Flow.execute_flow_line", allowed_words=names("LF"),
            allows_block_delete=False,
            mdi_error_text=
                "{code} ends a loop, but no loop was started.",
                other_diagnostic_codes=names("loop-unopened")),
        make_flow_entry("P", "Pn", "Runs subroutine n.", "P4", "}4\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.call_subroutine", allowed_words=names("P"),
            calls_subroutine=True,
            mdi_error_text=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            other_diagnostic_codes=names("recursion subroutine-missing")),
        make_flow_entry("}", "}n",
        "Marks the start of subroutine n; subroutines are written after the end of the program.",
        "M98P5", "}5\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.execute_flow_line", allowed_words=names("}"),
            allows_block_delete=False,
            mdi_error_text=
                "{code} cannot define a subroutine in MDI; subroutines are possible only in a program.",
            other_diagnostic_codes=names("subroutine-open subroutine-twice word-missing")),
        make_flow_entry("M98", "M98Pn", "Runs subroutine n.", "M98P2", "}2\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.call_subroutine", allowed_words=names("P M"),
            calls_subroutine=True,
            mdi_error_text=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            other_diagnostic_codes=names("recursion subroutine-missing")),
        make_flow_entry("M99", "M99", "Ends a subroutine.", "M98P3", "}3\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.execute_flow_line", allowed_words=names("M"),
            allows_block_delete=False,
            mdi_error_text=
                "{code} ends a subroutine, but no subroutine was started.",
                other_diagnostic_codes=names("m99-outside")),
        make_flow_entry("M95", "M95",
        "Runs subroutine 1 if TB2-9 is closed.", "M95", "}1\nX.55\nM99\n",
            handler="flow.loops_and_subroutines:Flow.call_subroutine", allowed_words=names("M"),
            required_input=("TB2-9",
            True), calls_subroutine=True,
            depends_on_input=True, mdi_error_text=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            other_diagnostic_codes=names("recursion subroutine-missing")),
        make_flow_entry("M97", "M97InCnPn",
        "Runs subroutine P if input I is on (with C1) or off (with C0).", "M97I10C1P6",
            "}6\nX.55\nM99\n", handler="flow.loops_and_subroutines:Flow.call_subroutine",
            allowed_words=names("C I P M"),
            calls_subroutine=True, depends_on_input=True, mdi_error_text=
                "{code} cannot call a subroutine in MDI; subroutine calls are possible only in a program.",
            word_rules={
                "C": WordRule(
                "required state of the input, on (1) or off (0)", minimum=0, maximum=1,
                requires_whole_number=True,
                invalid_error=ErrorTemplate(
                    "condition",
                    "The line contains {word}, which is neither C1 (on) nor C0 (off).",
                    "Write C1 or C0.")),
                    "I": WordRule("the number of the input", minimum=1, requires_whole_number=True,
                    invalid_error=ErrorTemplate(
                    "input-number",
                    "The line contains {word}, which is not an input number.",
                    "Write the number of the input.")),
            },
            other_diagnostic_codes=names("recursion subroutine-missing")),
        make_m_code_entry("M91", "M91", "Waits until TB2-5 is open.", "M91",
            action_kind=ActionKind.START, handler="setup.m_codes:wait_for_input", required_input=("TB2-5",
            False)),
        make_m_code_entry("M92", "M92", "Waits until TB2-5 is closed.", "M92",
            action_kind=ActionKind.START, handler="setup.m_codes:wait_for_input", required_input=("TB2-5",
            True)),
        make_m_code_entry("M93", "M93", "Waits until TB2-7 is open.", "M93",
            action_kind=ActionKind.START, handler="setup.m_codes:wait_for_input", required_input=("TB2-7",
            False)),
        make_m_code_entry("M94", "M94", "Waits until TB2-7 is closed.", "M94",
            action_kind=ActionKind.START, handler="setup.m_codes:wait_for_input", required_input=("TB2-7",
            True)),
        make_m_code_entry("M00", "M00", "Stops the program; the comment shows the operator what to do.",
            "M00(TURN THE PART AROUND)", action_kind=ActionKind.STOP, handler="setup.m_codes:stop_program"),
        make_m_code_entry("M01", "M01", "Stops the program if Optional Stop is on.", "M01(CHECK THE TOOL)",
            action_kind=ActionKind.STOP, handler="setup.m_codes:stop_program"),
        make_m_code_entry("M02", "M02",
        "Ends the program without changing the M functions.", "/M02",
            action_kind=ActionKind.STOP, handler="setup.m_codes:end_program", ends_program=True,
            other_diagnostic_codes=names("after-end no-end")),
        make_m_code_entry("M30", "M30",
        "Ends the program and turns the M functions off. With Cycle Repeat on, the "
        "program repeats.", "/M30",
            action_kind=ActionKind.STOP, handler="setup.m_codes:end_program", ends_program=True,
            other_diagnostic_codes=names("after-end no-end")),
        make_m_code_entry("M31", "M31", "Turns Cycle Repeat off.", "M31",
            action_kind=ActionKind.STOP, handler="setup.m_codes:cancel_repeat"),
        make_letter_entry("/", "/",
        "At the start of a line, skips the line while Block Delete is on.", "/X.55",
            handler="omniturn_statement:make_statement"),
        make_letter_entry("()", "(text)",
        "Comment. The screen shows it to the operator from this line on.", "X.55(WATCH THE CHUCK)",
            handler="omniturn_statement:make_statement"),
    )),
    ("Machine functions", (
        make_m_code_entry("M08", "M08", "Turns the coolant on.", "M08", action_kind=ActionKind.START,
        handler="setup.m_codes:coolant"),
        make_m_code_entry("M09", "M09", "Turns the coolant off.", "M09", action_kind=ActionKind.STOP,
        handler="setup.m_codes:coolant"),
        make_m_code_entry("M12", "M12", "Clamps the collet.", "M12", action_kind=ActionKind.START,
            handler="setup.m_codes:switch_collet"),
        make_m_code_entry("M13", "M13", "Unclamps the collet.", "M13\nG04F.5\nM12",
            action_kind=ActionKind.START, handler="setup.m_codes:switch_collet",
            rejection_conditions={RejectionCondition.SPINDLE_TURNING: ErrorTemplate(
                "unclamp-turning", "M13 opens the collet while the spindle turns.",
                "Stop the spindle with M05 first.", "M")}),
    )),
    ("Plane switching", (
        _plane("~PLXC", "(~PLXC) … (END)",
        "Mills the face: program X and Y across the face; the machine moves X and C.",
            "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLXC)\n(X.25Y0)\n(X.25Y.2)\n(END)\nM28\nM05",
            other_diagnostic_codes=_PLANE | names("plane-centre plane-h-late plane-reach")),
        _plane("~PLZC", "(~PLZC) … (END)",
        "Mills the side: program X along the part and Y around it; the machine moves Z and C.",
            "T2\nX-.5Z.1\nM05\nG94F20\nM19S60\nG04F3\nM27\n(~PLZC)\n(D1.)\n(X.25Y.2)\n(X.5Y0)\n(END)\nM28\nM05",
            other_diagnostic_codes=_PLANE | names("plane-d-late plane-diameter")),
    )),
)
# fmt: on
