"""The code book of Klartext: SL cycles, which mill pockets and islands of a contour of their own."""

from __future__ import annotations

from core.language.code_book import Entry
from core.message import Message

_POCKET = "LBL 1\nL X+0 Y+0 RR\nL Y+40\nRND R6\nL X+60\nL Y+0\nL X+0\nLBL 0\n"
_ISLAND = "LBL 2\nL X+38 Y+20 RL\nCC X+30 Y+20\nC X+38 Y+20 DR-\nLBL 0\n"
_TRAIN = "LBL 1\nL X+0 Y+0 RL\nL X+60\nRND R8\nL Y+40\nLBL 0\n"
_NAMED = "CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL1 /2"
_TRAIN_NAMED = "CYCL DEF 14.0 CONTOUR\nCYCL DEF 14.1 CONTOUR LABEL1"


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
                "Lists the pockets (P) and islands (I), as cycle 14 does. Each of them is LBL n or a "
                "program name in quotes."
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
