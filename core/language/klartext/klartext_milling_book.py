"""The code book of Klartext: back boring, circular slots, the older cycles 210 to 215."""

from __future__ import annotations

from core.language.code_book import Entry
from core.message import Message

_HEIGHTS = "Q203=+0 Q204=30"
_OLD = f"Q200=2 Q201=-10 Q207=500 Q202=5 {_HEIGHTS} Q216=+50 Q217=+50"
_UPWARDS = ("Q201=-", "Q201=+", "positive (upward)")
_OF_A_CYCLE = {
    204: (
        "BACK BORING",
        (
            "Back boring: with the spindle at angle Q336, the tool enters the hole offset "
            "from the center by Q251, then bores from below."
        ),
        "Q200=2 Q249=+5 Q250=20 Q251=3.5 Q252=15 Q253=750 Q254=200 Q255=0 Q203=+0 Q204=50 Q214=1 Q336=+0",
        ("Q214=1", "Q214=0", "Q214"),
    ),
    210: (
        "SLOT RECIP. PLNG",
        "Mills a slot with back-and-forth moves.",
        f"{_OLD} Q215=0 Q218=80 Q219=12 Q224=+0",
        _UPWARDS,
    ),
    211: (
        "CIRCULAR SLOT",
        "Mills a circular slot.",
        f"{_OLD} Q215=0 Q244=60 Q219=12 Q245=+0 Q248=90",
        _UPWARDS,
    ),
    212: (
        "POCKET FINISHING",
        "Finishes the wall of a rectangular pocket.",
        f"{_OLD} Q206=150 Q218=80 Q219=60 Q220=5 Q221=0",
        _UPWARDS,
    ),
    213: (
        "STUD FINISHING",
        "Finishes the wall of a rectangular stud.",
        f"{_OLD} Q206=150 Q218=60 Q219=40 Q220=5 Q221=0",
        _UPWARDS,
    ),
    214: (
        "C. POCKET FINISHING",
        "Finishes the wall of a circular pocket.",
        f"{_OLD} Q206=150 Q222=79 Q223=80",
        _UPWARDS,
    ),
    215: (
        "C. STUD FINISHING",
        "Finishes the wall of a round stud.",
        f"{_OLD} Q206=150 Q222=81 Q223=80",
        _UPWARDS,
    ),
    254: (
        "CIRCULAR SLOT",
        "Mills circular slots on a pitch circle.",
        "Q215=0 Q219=12 Q368=0.2 Q375=60 Q367=0 Q216=+50 Q217=+50 Q376=+0 Q248=90 Q378=0 Q377=1 "
        "Q207=500 Q351=+1 "
        f"Q201=-5 Q202=5 Q369=0.1 Q206=150 Q338=5 Q200=2 {_HEIGHTS} Q366=1 Q385=250",
        _UPWARDS,
    ),
}


def milling() -> tuple[Entry, ...]:
    """Cycles 204, 210 to 215, 254."""

    def entry(number: int, name: str, what: str, parameters: str, spoilt: tuple[str, str, str]) -> Entry:
        before, after, why = spoilt
        body = Message(
            "CYCL DEF {number} {name}{item}",
            number=number,
            name=name,
            item="".join(f" ~\n  {each}" for each in parameters.split()),
        )
        call = "\nL X+40 Y+40 R0 FMAX M99"
        wrong = body.replace(before, after) + call
        return Entry(
            Message("CYCL DEF {number}", number=number), name, what, body + call, wrong, why, insert=body
        )

    return tuple(entry(number, *told) for number, told in sorted(_OF_A_CYCLE.items()))
