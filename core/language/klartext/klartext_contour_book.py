"""The code book of Klartext: SL cycles, which mill pockets and islands of a contour of their own."""

from __future__ import annotations

from core.language.code_book import Entry
from core.message import Message

_POCKET = "LBL 1\nL X+0 Y+0 RR\nL Y+40\nRND R6\nL X+60\nL Y+0\nL X+0\nLBL 0\n"
_ISLAND = "LBL 2\nL X+38 Y+20 RL\nCC X+30 Y+20\nC X+38 Y+20 DR-\nLBL 0\n"
_TRAIN = "LBL 1\nL X+0 Y+0 RL\nL X+60\nRND R8\nL Y+40\nLBL 0\n"
_NAMED = "CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL1 /2"
_TRAIN_NAMED = "CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL1"


_OLDER = {
    6: (
        "ROUGH-OUT",
        (
            "Clears the pocket of cycle 14 in rings, starting at the current tool position and "
            "plunging along a ramp."
        ),
        "SET UP2 DEPTH-5|PECKG5 F150 ALLOW+0.2|ANGLE+0 F400",
        ("F400", "FMAX", "rapid"),
    ),
    15: (
        "PILOT DRILLING",
        (
            "Drills where a tool with the radius of the active tool would plunge; in TurnDesk, "
            "cycle 6 does not need this hole."
        ),
        "SET UP2 DEPTH-5|PECKG5 F150 ALLOW+0.2",
        ("F150", "FMAX", "rapid"),
    ),
    16: (
        "CONTOUR MILLING",
        "Mills along the walls of the pocket and its islands.",
        "SET UP2 DEPTH-5|PECKG5 F150|DR+ F400",
        ("F400", "FMAX", "rapid"),
    ),
}
_CIRCLE = (
    ("ROUND.H", "BEGIN PGM ROUND MM\nCC X+30 Y+20\nLP PR+15 PA+0\nCP IPA+360 DR+\nEND PGM ROUND MM\n"),
)
_MODEL = (
    *_CIRCLE,
    ("MODEL.H", 'BEGIN PGM MODEL MM\nDECLARE CONTOUR QC1 = "ROUND"\nQC10 = QC1 | QC1\nEND PGM MODEL MM\n'),
)
_DECLARED = 'DECLARE CONTOUR QC1 = "ROUND"'


def _told(number: int, name: str, parameters: str) -> str:
    return Message(
        "CYCL DEF {number} {name}{item}",
        number=number,
        name=name,
        item="".join(f" ~\n  {each}" for each in parameters.split()),
    )


_DATA = _told(20, "CONTOUR DATA", "Q1=-5 Q2=+1 Q3=+0.2 Q4=+0.1 Q5=+0 Q6=+2 Q7=+50 Q8=+0.2 Q9=+1")
_ROUGH = _told(22, "ROUGH-OUT", "Q10=-5 Q11=150 Q12=400 Q18=0 Q19=200 Q208=99999 Q401=100 Q404=0")
_OF_A_CYCLE = {
    21: (
        "PILOT DRILLING",
        "Drills at the points where the tool with the number Q13 plunges in cycle 22.",
        "Q10=-5 Q11=150 Q13=1",
        ("Q13=1", "Q13=99", "Q13"),
    ),
    22: (
        "ROUGH-OUT",
        ("Clears the pocket of cycle 14 level by level, around its islands; plunges vertically if Q19 is 0."),
        "Q10=-5 Q11=150 Q12=400 Q18=0 Q19=200 Q208=99999 Q401=100 Q404=0",
        ("Q12=400", "Q12=99999", "rapid"),
    ),
    23: (
        "FLOOR FINISHING",
        "Mills the pocket floor at the pocket depth.",
        "Q11=100 Q12=200 Q208=99999",
        ("Q12=200", "Q12=99999", "rapid"),
    ),
    24: (
        "SIDE FINISHING",
        "Mills along the walls of the pocket and its islands, leaving the allowance Q14.",
        "Q9=+1 Q10=-5 Q11=100 Q12=200 Q14=+0",
        ("Q12=200", "Q12=99999", "rapid"),
    ),
}


def _older(number: int, name: str, what: str, lines: str, spoilt: tuple[str, str, str]) -> Entry:
    before, after, why = spoilt
    told = (name, *lines.split("|"))
    body = "\n".join(
        Message("CYCL DEF {number}.{part} {line}", number=number, part=part, line=line)
        for part, line in enumerate(told)
    )
    return Entry(
        Message("CYCL DEF {number}", number=number),
        f".0 {name}",
        what,
        f"{_NAMED}\n{body}\nCYCL CALL",
        f"{_NAMED}\n{body.replace(before, after)}\nCYCL CALL",
        why,
        behind=_POCKET + _ISLAND,
        insert=body,
    )


def _formulas() -> tuple[Entry, ...]:
    """Contours of other programs, and how they are joined."""
    return (
        Entry(
            "DECLARE CONTOUR",
            'QCn = "name"',
            "Assigns a closed contour to QCn. The contour is a separate program (name in quotes) or LBL n.",
            f"{_DECLARED}\nCONTOUR DEF P1 = QC1\n{_DATA}\n{_ROUGH}\nCYCL CALL",
            Message("{declared} DEPTH5", declared=_DECLARED),
            "a separate depth",
            files=_CIRCLE,
        ),
        Entry(
            "QC",
            "n = formula",
            (
                "Combines contours into the area to mill: | is the area in either contour, & the "
                "area in both, \\ the area in the first but not in the second, and ^ the area in only "
                "one of the two."
            ),
            f"{_DECLARED}\nQC10 = QC1 | QC1\n{_DATA}\n{_ROUGH}\nCYCL CALL",
            f"{_DECLARED}\nQC10 = QC1 | QC1 & QC1",
            "without parentheses",
            files=_CIRCLE,
        ),
        Entry(
            "SEL CONTOUR",
            '"name"',
            "Uses the contour formula of another program.",
            f'SEL CONTOUR "MODEL"\n{_DATA}\n{_ROUGH}\nCYCL CALL',
            'SEL CONTOUR "ROUND"',
            "no contour formula",
            files=_MODEL,
        ),
    )


def contours() -> tuple[Entry, ...]:
    """Cycles 14 and 20 to 25, and CONTOUR DEF."""

    def milled(number: int, name: str, what: str, parameters: str, spoilt: tuple[str, str, str]) -> Entry:
        before, after, why = spoilt
        body = _told(number, name, parameters)
        example = f"{_NAMED}\n{_DATA}\n{body}\nCYCL CALL"
        wrong = f"{_NAMED}\n{_DATA}\n{body.replace(before, after)}\nCYCL CALL"
        return Entry(
            Message("CYCL DEF {number}", number=number),
            name,
            what,
            example,
            wrong,
            why,
            behind=_POCKET + _ISLAND,
            insert=body,
        )

    train = _told(25, "CONTOUR TRAIN", "Q1=-5 Q3=+0 Q5=+0 Q7=+50 Q10=-5 Q11=100 Q12=400 Q15=+1")
    return (
        Entry(
            "CYCL DEF 14",
            ".0 CONTOUR",
            "Lists the subprograms that define pockets (clockwise with RR) and islands (clockwise with RL).",
            f"{_NAMED}\n{_DATA}\n{_ROUGH}\nCYCL CALL",
            f"CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL7\n{_DATA}\n{_ROUGH}\nCYCL CALL",
            "LBL 7",
            behind=_POCKET + _ISLAND,
            insert=_NAMED,
        ),
        Entry(
            "CONTOUR DEF",
            "P1 = LBL n I2 = LBL n",
            (
                "Lists the pockets (P) and islands (I), as cycle 14 does. Each of them is LBL n, a "
                "program name in quotes, or QC n."
            ),
            f"CONTOUR DEF P1 = LBL 1 I2 = LBL 2\n{_DATA}\n{_ROUGH}\nCYCL CALL",
            f'CONTOUR DEF P1 = "POCKET.H"\n{_DATA}\n{_ROUGH}\nCYCL CALL',
            "POCKET.H",
            behind=_POCKET + _ISLAND,
        ),
        Entry(
            "CYCL DEF 20",
            "CONTOUR DATA",
            "Sets depth, overlap, allowances, heights and milling direction for cycles 21 to 24.",
            f"{_NAMED}\n{_DATA}\n{_ROUGH}\nCYCL CALL",
            _DATA.replace("Q1=-5", "Q1=+5"),
            "upward",
            behind=_POCKET + _ISLAND,
            insert=_DATA,
        ),
        *(milled(number, *told) for number, told in _OF_A_CYCLE.items()),
        *(_older(number, *told) for number, told in _OLDER.items()),
        *_formulas(),
        Entry(
            "CYCL DEF 25",
            "CONTOUR TRAIN",
            "Mills along an open or closed contour, on the side set by RL or RR.",
            f"{_TRAIN_NAMED}\n{train}\nCYCL CALL",
            f"{_TRAIN_NAMED}\n{train.replace('Q12=400', 'Q12=99999')}\nCYCL CALL",
            "rapid",
            behind=_TRAIN,
            insert=train,
        ),
    )
