"""Drive families and the properties that their EDS files do not contain.

Objects and data types are from the EDS files and manuals of the vendors: maxon for EPOS2 and EPOS4, Copley
for Accelnet and Xenus. All other drives, such as those of Schunk and Pilz, are treated as standard CiA 402
drives.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple


class PdoEntry(NamedTuple):
    """Object that is mapped to a PDO."""

    object_index: int
    object_subindex: int
    bit_count: int
    is_signed: bool = False


class RecordFormat(Enum):
    """Format of the records of position, velocity and time in the queue of a drive."""

    EPOS2 = "20C1"
    COPLEY = "2010"


INPUT_ENTRY = PdoEntry(0x60FD, 0, 32)


class DriveQueue(NamedTuple):
    """Record queue in a drive.

    ``submode`` is the value for object 60C0h, and ``max_record_count`` the number of records that may be
    queued.
    """

    record_format: RecordFormat
    object_index: int
    submode: int
    max_record_count: int


@dataclass(frozen=True, slots=True)
class DriveProfile:
    """Profile of a drive family.

    If ``uses_rpm`` is true, the family uses rpm and rpm/s as units, so the counts per revolution are
    required.
    """

    name: str
    display_name: str
    uses_rpm: bool = False
    supported_mode_bits: int = 0  # Bits of 0x6502 that apply even if not reported.
    digital_input_entry: PdoEntry = INPUT_ENTRY  # digital inputs
    home_offset_object: int = 0x607C  # Object of the home offset.
    record_queue: DriveQueue | None = None
    unit_objects: tuple[tuple[int, int, int], ...] = ()  # Written first to select these units.
    vendor_id: int = 0  # Vendor in the EDS file; `words` are parts of the product name.
    product_name_words: tuple[str, ...] = ()


_MAXON, _COPLEY = 0x000000FB, 0x000000AB
CIA402_PROFILE = DriveProfile("cia402", "a CiA 402 drive")
PROFILES = {
    profile.name: profile
    for profile in (
        CIA402_PROFILE,
        DriveProfile(
            "epos2",
            "maxon EPOS2",
            uses_rpm=True,
            digital_input_entry=PdoEntry(0x2071, 1, 16),
            record_queue=DriveQueue(RecordFormat.EPOS2, 0x20C1, -1, 56),  # The drive accepts 64.
            vendor_id=_MAXON,
            product_name_words=("EPOS2",),
        ),
        DriveProfile(
            "epos4",
            "maxon EPOS4",
            uses_rpm=True,
            supported_mode_bits=0x01 | 0x04 | 0x20 | 0x80,  # PP, PV, homing, CSP
            home_offset_object=0x30B0,
            # SI unit codes: positions in increments, speeds in rpm, accelerations in rpm/s.
            unit_objects=((0x60A8, 0, 0x00B50000), (0x60A9, 0, 0x00B44700), (0x60AA, 0, 0x00C00300)),
            vendor_id=_MAXON,
            product_name_words=("EPOS4",),
        ),
        DriveProfile(
            "copley",
            "Copley Accelnet or Xenus",
            record_queue=DriveQueue(RecordFormat.COPLEY, 0x2010, -2, 26),  # The drive accepts 32.
            vendor_id=_COPLEY,
        ),
    )
}
QUEUE_PROFILE_NAMES = tuple(name for name, profile in PROFILES.items() if profile.record_queue is not None)
RPM_PROFILE_NAMES = tuple(name for name, profile in PROFILES.items() if profile.uses_rpm)


def find_drive_profile(name: str, vendor_id: int | None, product_name: str | None) -> DriveProfile:
    """Return the profile of the drive family with this name.

    If ``name`` is empty, the vendor and product in the EDS file determine the family.
    """
    if name:
        return PROFILES[name]
    for profile in PROFILES.values():
        named = not profile.product_name_words or any(
            word in (product_name or "").upper() for word in profile.product_name_words
        )
        if profile.vendor_id and profile.vendor_id == vendor_id and named:
            return profile
    return CIA402_PROFILE


MISSING_OBJECT_EFFECTS = {
    0x1006: "SYNC period: the drive does not detect a missing SYNC",
    0x1016: ("heartbeat monitoring: the drive does not detect that this computer has stopped responding"),
    0x1017: "heartbeat: TurnDesk detects a lost drive only when the drive stops responding to SYNC",
    0x1029: "reaction to a bus error: the drive uses its own setting",
    0x1400: (
        "setpoint timeout: the drive remains at the last setpoint until it has missed three "
        "of TurnDesk's heartbeats"
    ),
    0x605A: "quick stop option: the drive uses its own setting",
    0x605E: "fault reaction: the drive uses its own setting",
    0x6007: (
        "reaction to a lost connection to this computer: not specified, so the drive's "
        "enable signal needs a watchdog relay"
    ),
    0x6065: "following error window: only TurnDesk monitors the following error",
    0x6066: (
        "following error timeout: the drive faults as soon as the following error is outside the window"
    ),
    0x607C: "home offset: home is where the drive's position count is 0",
    0x607D: "software limits: only TurnDesk's limits apply",
    0x6083: "profile acceleration: the drive uses its own setting",
    0x6084: "profile deceleration: the drive decelerates at its acceleration rate",
    0x6085: "quick stop deceleration: the drive uses its own setting",
    0x6099: "homing speeds: the drive uses its own settings",
    0x609A: "homing acceleration: the drive uses its own setting",
    0x60A8: "position unit: the drive uses its own setting",
    0x60A9: "velocity unit: the drive uses its own setting",
    0x60AA: "acceleration unit: the drive uses its own setting",
    0x60C0: "interpolation sub-mode: the drive uses its own setting",
    0x60C2: "interpolation time: set this time to sync_ms with the drive vendor's software",
}
"""Effect of a missing optional drive object, by object index."""
