"""Which language a program is written in."""

from __future__ import annotations

from enum import StrEnum
from pathlib import PurePath


class Dialect(StrEnum):
    """The words are those of the command line and of the JSON."""

    OMNITURN = "omniturn"
    KLARTEXT = "klartext"
    SINUMERIK = "sinumerik"


_BY_ENDING = {".h": Dialect.KLARTEXT, ".mpf": Dialect.SINUMERIK, ".spf": Dialect.SINUMERIK}


def dialect_of(name: str) -> Dialect:
    """The dialect that a file of this name holds where nobody says otherwise."""
    return _BY_ENDING.get(PurePath(name).suffix.lower(), Dialect.OMNITURN)
