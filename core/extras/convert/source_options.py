"""Controls whose programs can be converted, and the options of a conversion."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class SourceControl(StrEnum):
    """Control for which a program was written. The values are the choices of the option ``--from``."""

    FANUC_A = "fanuc-a"
    FANUC_B = "fanuc-b"
    HAAS = "haas"
    LINUXCNC = "linuxcnc"
    MACH = "mach"

    @property
    def uses_code_system_a(self) -> bool:
        """Return whether the control uses G-code system A.

        In system A, U and W are increments and G90 is a cycle.
        """
        return self in {SourceControl.FANUC_A, SourceControl.HAAS}

    @property
    def axis_letters(self) -> str:
        """Return the letters of the coordinates and increments of the axes X and Z."""
        return "XZUW" if self.is_fanuc else "XZ"

    @property
    def is_fanuc(self) -> bool:
        """Return whether words, cycles and macros have the same meaning as on Fanuc controls."""
        return self not in {SourceControl.LINUXCNC, SourceControl.MACH}


class TargetControl(StrEnum):
    """Control for which a program is written. The values are the choices of the option ``--to``."""

    OMNITURN = "omniturn"
    LINUXCNC = "linuxcnc"
    FANUC = "fanuc"
    SINUMERIK = "sinumerik"


@dataclass(frozen=True, slots=True)
class ConversionOptions:
    """Options of a conversion, mainly facts that the text of the source program does not contain.

    - ``no_point``: meaning of the number 1 without a decimal point: 0 if not specified, 1 for a whole
      unit, or 0.001 for the least increment (0.001 mm or 0.0001 in)
    - ``metric`` and ``diameter``: unit and meaning of X if the program does not select them; None
      means not specified
    - ``front``: whether G02 and G03 are seen with X+ toward the operator
    - ``skipped_m_codes``: M codes to omit
    """

    control: SourceControl
    no_point: float = 0.0
    metric: bool | None = None
    diameter: bool | None = None
    front: bool = False
    skipped_m_codes: frozenset[int] = frozenset()
    writes_comments: bool = True
    rapid: float = 7620.0  # mm/min
    max_rpm: float = 3500.0
    max_feed_mm_min: float = 7620.0  # mm/min
    m_codes: frozenset[int] = frozenset()  # M codes that the machine file of the target defines
