"""Keys of the JSON that ``turndesk share`` prints, for the reference and its tests."""

from __future__ import annotations

from core.json_key import Output, below, keys

_VERSION = keys(
    """
id | string | | ID of the version.
desk | string | | Machine that saved the version.
saved | string | UTC | Time at which it was saved.
size | integer | bytes | Size of the program.
why | string | | Reason for saving.
follows | list | | IDs of the versions on which it is based.
"""
)
_SHARED = (
    *keys(
        """
place | string | | The shared location.
desk | string | | Name of this machine in the list of machines.
trouble | string or null | | Why the shared location does not respond; null if it responds.
waiting | integer | | Versions that are not yet published.
programs | list | | Shared programs.
programs[].program | string | | File name of the program.
programs[].state | string | | same, newer (a newer version exists on another machine), both (changed here
    and on another machine) or new (not on this machine).
programs[].here | object or null | | Version on this machine; null if not available.
"""
    ),
    *below("programs[].here.", _VERSION),
    *keys(
        "programs[].elsewhere | list | | Newest versions of other machines that this machine does not have."
    ),
    *below("programs[].elsewhere[].", _VERSION),
    *keys(
        """
programs[].elsewhere[].on | list | | Machines that have this version.
programs[].versions | integer | | Number of known versions.
desks | list | | Machines that share programs.
desks[].desk | string | | Name of the machine.
desks[].told | string | UTC | Time of its last report.
desks[].has | object | | Its programs.
desks[].has.* | string | | ID of the version, by program.
strays | list | | Files in the shared location that are not versions.
not_shared | object | | Programs that are not shared.
not_shared.* | string | | Reason, by program.
"""
    ),
)
SHARE_STATUS = Output("share status --json, share publish --json", "One object.", _SHARED)
SHARE_BEGIN = Output("share begin --json", "One object.", keys("place | string | | The shared location."))
SHARE_COMPARE = Output(
    "share compare PROGRAM --json",
    "One object.",
    (
        *keys("version | object | | The version that is compared."),
        *below("version.", _VERSION),
        *keys(
            """
changes | list | | Lines of the comparison.
changes[].sign | string | | + (added), − as a hyphen (removed) or a space (unchanged).
changes[].here | integer or null | | Line in the local program; null if the local program does not contain it.
changes[].there | integer or null | | Line in the other version; null if that version does not contain it.
changes[].text | string | | Text of the line.
"""
        ),
    ),
)
SHARE_TAKE = Output(
    "share take PROGRAM --json",
    "One object.",
    (
        *keys("taken | object | | The version that was copied."),
        *below("taken.", _VERSION),
        *keys("file | string | | File name in the program folder."),
    ),
)
SHARE_KEEP = Output(
    "share keep PROGRAM --json",
    "One object.",
    keys(
        """
kept | string | | File name of the program.
trouble | string | | Why the version is not published yet; empty if it is published.
"""
    ),
)
OUTPUTS = {"store verify --json": (SHARE_BEGIN, SHARE_STATUS, SHARE_COMPARE, SHARE_TAKE, SHARE_KEEP)}
