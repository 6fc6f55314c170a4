"""The code book of Klartext: thread milling, faces, circular slots, the older cycles 210 to 215."""

from __future__ import annotations

from core.language.code_book import Entry
from core.message import Message

_HEIGHTS = "Q203=+0 Q204=30"
_THREAD = "Q335=16 Q239=+1.5 Q201=-16"
_FRONT = "Q358=+0 Q359=+0"
_OLD = f"Q200=2 Q201=-10 Q207=500 Q202=5 {_HEIGHTS} Q216=+50 Q217=+50"
_FACE = "Q202=2 Q369=0.2 Q370=1 Q207=500 Q385=250 Q253=750 Q200=2 Q357=2 Q204=30"
_RAPID = ("Q207=500", "Q207=99999", "rapid")
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
    262: (
        "THREAD MILLING",
        (
            "Mills an internal thread; Q355: 0 = one turn, 1 = turns over the whole depth, n = "
            "one turn every n pitches."
        ),
        f"{_THREAD} Q355=0 Q253=750 Q351=+1 Q200=2 {_HEIGHTS} Q207=500",
        _UPWARDS,
    ),
    263: (
        "THREAD MLLNG/CNTSNKG",
        "Countersinks and mills an internal thread.",
        f"{_THREAD} Q356=-20 Q253=750 Q351=+1 Q200=2 Q357=0.2 {_FRONT} {_HEIGHTS} Q254=150 Q207=500",
        _UPWARDS,
    ),
    264: (
        "THREAD DRILLNG/MLLNG",
        "Drills and mills an internal thread.",
        f"{_THREAD} Q356=-20 Q253=750 Q351=+1 Q202=5 Q258=0.2 Q257=0 Q256=0.2 {_FRONT} Q200=2 {_HEIGHTS} "
        "Q206=150 Q207=500",
        _UPWARDS,
    ),
    265: (
        "HEL.THREAD DRLG/MLG",
        "Mills an internal thread into solid material, downward along a helix.",
        f"{_THREAD} Q253=750 {_FRONT} Q360=0 Q200=2 {_HEIGHTS} Q254=150 Q207=500",
        _UPWARDS,
    ),
    267: (
        "OUTSIDE THREAD MLLNG",
        "Mills an external thread on a stud.",
        f"{_THREAD} Q355=0 Q253=750 Q351=+1 Q200=2 {_FRONT} {_HEIGHTS} Q254=150 Q207=500",
        _UPWARDS,
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
    230: (
        "MULTIPASS MILLING",
        "Mills a face in Q240 passes.",
        "Q225=+0 Q226=+0 Q227=+2 Q218=80 Q219=60 Q240=12 Q206=150 Q207=500 Q209=200 Q200=2",
        _RAPID,
    ),
    231: (
        "RULED SURFACE",
        "Mills the surface between two lines in Q240 passes, with the tool tip.",
        "Q225=+0 Q226=+0 Q227=-2 Q228=+80 Q229=+0 Q230=-2 Q231=+80 Q232=+50 Q233=-5 Q234=+0 Q235=+50 Q236=-5 "
        "Q240=20 Q207=500",
        ("Q240=20", "Q240=1", "number of cuts"),
    ),
    232: (
        "FACE MILLING",
        "Mills a face from Q227 down to Q386; Q389 selects the milling strategy for the passes.",
        f"Q389=0 Q225=+0 Q226=+0 Q227=+2 Q386=-3 Q218=80 Q219=60 {_FACE}",
        _RAPID,
    ),
    233: (
        "FACE MILLING",
        (
            "Mills a face as cycle 232 does; Q367 sets the face position relative to the current "
            "tool position, and Q350 selects the axis of the milling direction."
        ),
        f"Q215=0 Q389=0 Q350=1 Q218=80 Q219=60 Q227=+2 Q386=-3 {_FACE} Q347=0 Q348=0 Q349=0",
        ("Q347=0", "Q347=1", "limit"),
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
    """Cycles 204, 210 to 215, 230 to 233, 254, 262 to 267."""

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
