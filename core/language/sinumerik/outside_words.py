"""Words of the SINUMERIK language that this control does not execute, and what to write instead.

They are refused by their names, so that none is taken for a subprogram or a variable.
"""

from __future__ import annotations

from collections.abc import Mapping

_ONE_CHANNEL = "this control has one channel, and its axes are its own"
_FEEDS = "F is the feed of the path; write F, FB or OVR"
_LIMITS = "the limits of an axis are those of the machine file; take it out"
_SYNCHRONOUS = "synchronized actions are not executed here"
_INTERRUPTS = "interrupts by an input are not executed here; stop with M0 or M1"
_MEASURES = "measuring in the program is not executed here; touch the tool off on the Jog page"
_STOPS = "travel to a fixed stop is not executed here"
_BESIDE = "axes do not move beside the path here; write G0 or G1 with the axis"
_ISO = "the other language mode is not read here"
_TOOL_AXIS = "this lathe has no orientation axes"
_SMOOTH = "smooth approach and retract is not executed here; write G41 or G42 with NORM or KONT"
_SIX = "this control keeps six settable offsets; write G54 to G59"
_SPLINE = "write the curve as lines and arcs"
_FILES = "programs do not read or write files here"
_FRAMES = "write the frame with TRANS, ROT, SCALE or MIRROR"
_PUNCHES = "this lathe does not punch"
_LOOKS_AHEAD = "the whole program is read before it begins; take it out"
_OSCILLATES = "oscillation is not executed here"
_TOOLS = "tools are managed on the page of tool offsets (F8)"
_CONTOURS = "contour tables are not made here; name the contour in CYCLE95"
_RETRACTS = "retraction by itself is not executed here"

_BY_REASON = {
    _SPLINE: (
        "ASPLINE BSPLINE CSPLINE POLY POLYPATH INVCW INVCCW BAUTO BNAT BTAN EAUTO ENAT ETAN "
        "SPLINEPATH SPATH UPATH"
    ),
    _TOOL_AXIS: (
        "TRAORI ORIWKS ORIMKS ORIAXES ORIVECT ORIEULER ORIRPY ORIS TCARR TCOABS TCOFR TOFRAME TOROT "
        "PAROT CUT3DC CUT3DF"
    ),
    _ONE_CHANNEL: (
        "GEOAX GET GETD RELEASE COUPON COUPOF COUPDEF COUPDEL COUPRES WAITC WAITM WAITE WAITP SETM "
        "CLEARM TRAILON TRAILOF LEADON LEADOF EGDEF EGON EGONSYN EGOFS EGOFC EGDEL CTABDEF CTABEND"
    ),
    _FEEDS: "FGROUP FA FD FDA FZ OVRA OVRRAP SVC STW",
    _LIMITS: (
        "FL VELOLIM VELOLIMA JERKLIM JERKLIMA BRISKA SOFTA DRIVEA JERKA PROTA PROTS PROTD CPROTDEF "
        "NPROTDEF CPROT NPROT COLLPAIR"
    ),
    _BESIDE: "POS POSA POSP OEMIPO REPOS REPOSA REPOSL REPOSQ REPOSH REPOSHA REPOSQA",
    _SYNCHRONOUS: (
        "WHEN WHENEVER EVERY CANCEL ID IDS DELDTG DELDT SYNFCT FTOC FTOCON FTOCOF LOCK UNLOCK PUTFTOC "
        "PUTFTOCF FCTDEF"
    ),
    _INTERRUPTS: "SETINT CLRINT DISABLE ENABLE PRIO BLSYNC",
    _RETRACTS: "LIFTFAST LFON LFOF LFTXT LFWP LFPOS POLF POLFMASK POLFMLIN ALF",
    _MEASURES: "MEAS MEAW MEAC MEASA MEAWA MEASURE",
    _STOPS: "FXS FXST FXSW FOC FOCON FOCOF",
    _FILES: (
        "WRITE READ DELETE ISFILE FILEDATE FILEINFO FILESIZE FILESTAT FILETIME EXTOPEN EXTCLOSE "
        "CALLPATH PCALL EXECSTRING EXECTAB"
    ),
    _FRAMES: "CTRANS CROT CROTS CSCALE CMIRROR CFINE MEAFRAME ROTS AROTS CRPL ADDFRAME",
    _PUNCHES: "SPOF SON PON SONS PONS PDELAYON PDELAYOF SPP SPN",
    _LOOKS_AHEAD: "IPTRLOCK IPTRUNLOCK DELAYFSTON DELAYFSTOF STOLF",
    _OSCILLATES: "OSP1 OSP2 OST1 OST2 OSB OSE OSNSC OSCILL OSCTRL WAITOS",
    _TOOLS: (
        "SETPIECE SETDNO GETDNO CHKDNO GETT GETSELT GETEXET NEWT DELT SETTA TCA TLIFT DZERO "
        "DELTOOLENV TOOLENV GETTCOR SETTCOR DELDL"
    ),
    _CONTOURS: "CONTPRON CONTDCON EXECUTE INTERSEC CALCDAT",
    "write SPOS, or M3 and M4": "SPCOF SPCON ASPOS",
}

OUTSIDE: Mapping[str, str] = {
    "G63": "write CYCLE840, which feeds the tap by its lead and turns it back",
    "G93": "inverse time feed is not executed here; write G94 or G95 with F",
    "G931": "feed by the time of the move is not executed here; write G94 or G95 with F",
    "G5": "G5 is not executed here; write the arc with CIP",
    "KONTC": "approach on a curve is not executed here; write KONT or NORM",
    "KONTT": "approach on a curve is not executed here; write KONT or NORM",
    "TURN": "a helix needs a third axis of the slides",
    "DIAMCYCOF": "write DIAMON, DIAMOF or DIAM90",
    "DISC": "write G450 or G451",
    "EXTCALL": "programs from outside are not called; put the file beside the main program and call its name",
    "TRAANG": "this lathe has no inclined axis",
    "TRACON": "transformations are not chained here",
    "FLIN": "write G1 with F a block",
    "FCUB": "write G1 with F a block",
    "FPO": "write G1 with F a block",
    "SAVE": "SAVE stands behind PROC",
    "GOTOC": "write GOTO, GOTOF or GOTOB",
    "ACC": "accelerations are those of the machine file; take it out",
    "ACCLIMA": "accelerations are those of the machine file; take it out",
    "FGREF": "F counts on the path of the tip here; take it out",
    "PRESETON": "positions of the machine are not preset here; write TRANS",
    "AXTOSPI": "the axis of a spindle is known from the machine file",
    "SPITOAX": "the axis of a spindle is known from the machine file",
    "MMC": "dialogs of a program are not shown here; write MSG",
    **dict.fromkeys(("DEFINE", "DEFAULT", "ENDPROC"), "macros are not made here; write their words"),
    **{word: why for why, words in _BY_REASON.items() for word in words.split()},
    "CYCLE": "a cycle has its number, such as CYCLE95",
    "G291": _ISO,
    **dict.fromkeys((f"G{code}" for code in (147, 148, 247, 248, 340, 341, 347, 348)), _SMOOTH),
    **dict.fromkeys((f"G{code}" for code in range(507, 600)), _SIX),
}
