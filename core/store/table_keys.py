"""The columns of the store's public tables and exports, for the reference page and its tests."""

from __future__ import annotations

from typing import NamedTuple

from core.json_keys import JsonKey, declare_keys, declare_row_keys
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CorrectionRow, CycleRow, ProductionStopRow
from core.store.production.tool_lives import InsertChange, ToolLifeRow
from core.store.store_rows import (
    EventRow,
    MillToolRow,
    PresetRow,
    SecondaryOffsetRow,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
)


class TableColumns(NamedTuple):
    """A table of the store with its name, its columns, and the export file that has the same columns."""

    name: str
    export_file: str
    purpose: str
    columns: tuple[JsonKey, ...]


_ID = declare_keys("id | integer | | Number of the row.")
_NUMBER = declare_keys("number | integer | | Number of the tool or offset.")
CYCLE_COLUMNS = """
key | | Key of the cycle, unique and independent of the clock.
program | | File name of the program.
part | | Number of the part, counted for this program; 0 if no part was counted.
started | UTC | Start of the cycle.
ended | UTC | End of the cycle; null if TurnDesk ended during it.
seconds | s | Cycle time without stops.
outcome | | How the cycle ended, such as COMPLETE.
load | % | Mean spindle load at feed; null if the drive does not report it.
"""
STOP_COLUMNS = """
key | | Key of the stop.
cycle | | Key of the cycle that was stopped; empty between two cycles.
program | | File name of the program.
at | UTC | Start of the stop.
seconds | s | Length of the stop.
reason | | Reason for the stop, as shown on the screen.
line | | Line of the program; 0 if not available.
"""
FEATURE_COLUMNS = """
id | | Number of the feature.
program | | File name of the program.
name | | Name of the feature.
kind | | diameter or length.
nominal | mm | Nominal size.
low | mm | Lower deviation from the nominal size.
high | mm | Upper deviation from the nominal size.
by_kind | | Table of the offset that corrects the feature: tool or secondary.
number | | Number of that offset.
grows | | 1 if the feature becomes larger when the offset becomes larger, −1 if it becomes smaller.
every | | Number of parts between two measurements; 0 if no interval is specified.
sample | | Number of parts in a sample.
"""
READING_COLUMNS = """
id | | Number of the reading.
feature | | Number of the feature.
part | | Number of the part.
value | mm | Measured size.
unit | | Unit in which the value was read: in or mm.
at | UTC | Time of the reading.
source | | typed or gauge.
gauge | | Name of the gauge; empty if the value was typed.
"""
OFFSET_CHANGE_COLUMNS = (
    "offset_change | | Newest offset change when the part was started; −1 if it is not known.\n"
)
CORRECTION_COLUMNS = """
id | | Number of the offset change.
at | UTC | Time of the change.
kind | | Table of the offset: tool or secondary.
number | | Number of the offset.
x | mm | Wear or secondary offset in X, a radius.
z | mm | Wear or secondary offset in Z.
part | | Number of parts that were made before the change.
why | | Reason for the change.
who | | User or TurnDesk function that made the change.
was_x | mm | Value in X before the change, a radius.
was_z | mm | Value in Z before the change.
"""
TOOL_LIFE_COLUMNS = """
number | | Number of the tool.
limit_parts | | Tool life in parts; 0 means unlimited.
limit_seconds | s | Tool life in time at feed; 0 means unlimited.
warn | | Fraction of the tool life at which a warning appears, 0 to 1.
stops | | 1: no further part starts when the tool life is used up; 0: production continues.
parts | | Parts made since the insert was changed.
seconds | s | Time at feed since the insert was changed.
"""
INSERT_CHANGE_COLUMNS = """
id | | Number of the change.
at | UTC | Time of the change.
number | | Number of the tool.
parts | | Parts that the insert had made.
seconds | s | Time at feed of the insert.
why | | Reason for the change.
kind | | Table of the tool: tool (lathe) or mill tool (mill).
who | | User or TurnDesk function that made the change.
"""
EVENT_COLUMNS = """
at | UTC | Time of the event.
kind | | Kind of the event.
text | | Sentence in English.
line | | Line of the program; 0 if not available.
record | | File of the scope data in the folder `records`; empty if not available.
who | | User who made a change.
"""
TOOL_OFFSET_COLUMNS = """
x | mm | Machine position in X, a radius, at which the tool tip is on part zero.
z | mm | Machine position in Z at which the tool tip is on part zero.
nose_radius | mm | Nose radius.
wear_x | mm | Wear in X, a radius.
wear_z | mm | Wear in Z.
quadrant | | Tip quadrant, 0 to 9; 0 if it is not specified.
remark | | Remark.
master | | Whether the tool is the master tool.
"""
SECONDARY_OFFSET_COLUMNS = """
x | mm | Secondary offset in X, a radius.
z | mm | Secondary offset in Z.
r | mm | Nose radius.
"""
ZERO_OFFSET_COLUMNS = """
x | mm | Machine position of part zero in X, a radius.
z | mm | Machine position of part zero in Z.
c | deg | Machine position of part zero in C.
"""
TOOL_SHAPE_COLUMNS = """
kind | | Kind of the tool.
hand | | right, left or neutral.
insert | | Designation of the insert; empty if it is not specified.
holder | | Outline or designation of the holder; empty if it is not specified.
width | mm | Width; 0 if it is not specified.
diameter | mm | Diameter; 0 if it is not specified.
point | deg | Point angle; 0 if it is not specified.
stick_out | mm | Stick-out; 0 if it is not specified.
length | mm | Cutting length; 0 if it is not specified.
pitch | mm | Pitch of a thread tool or tap; 0 if it is not specified.
flutes | | Number of flutes; 0 if it is not specified.
entry | deg | Entering angle; 0 if it is not specified.
rear | | Whether the tool works at negative X.
profile | | Outline of a form tool as `z,x z,x …` in mm.
"""
MILL_TOOL_COLUMNS = """
name | | Name of the tool.
length | mm | Length L.
radius | mm | Radius R.
corner | mm | Corner radius R2.
dl | mm | Oversize in length, DL.
dr | mm | Oversize in radius, DR.
dr2 | mm | Oversize in corner radius, DR2.
teeth | | Number of teeth.
point | deg | Point angle.
life | min | Tool life; 0 means unlimited.
stops | | 1: no further part starts when the tool life is used up; 0: production continues.
"""
PRESET_COLUMNS = """
x | mm | Machine position of the workpiece zero in X.
y | mm | Machine position of the workpiece zero in Y.
z | mm | Machine position of the workpiece zero in Z.
rotation | deg | Basic rotation about Z.
a | deg | Machine position of A at which it shows 0.
b | deg | Machine position of B at which it shows 0.
c | deg | Machine position of C at which it shows 0.
remark | | Remark.
"""


def _columns(
    row: type[tuple[object, ...]], text: str, renamed: dict[str, str] | None = None
) -> tuple[JsonKey, ...]:
    """Return the fields of a row type as columns.

    Booleans are declared as integers, as in SQLite.
    """
    columns = declare_row_keys("", row, text)
    names = renamed or {}
    return tuple(
        key._replace(name=names.get(key.name, key.name), type=key.type.replace("boolean", "integer"))
        for key in columns
    )


PUBLIC_TABLES = (
    TableColumns(
        "programs",
        "",
        "Programs that TurnDesk has saved.",
        declare_keys(
            """
id | integer | | Number of the program.
name | string | | File name of the program.
created | string | UTC | Time at which the program was first saved.
"""
        ),
    ),
    TableColumns(
        "program_versions",
        "",
        "All saved versions of the programs. The export contains the newest version in the "
        "folder `programs`.",
        declare_keys(
            """
id | integer | | Number of the row.
program | integer | | Number of the program in `programs`.
number | integer | | Number of the version, counted from 1.
text | blob | | The program as it was saved.
sha256 | string | | SHA-256 of the text.
saved | string | UTC | Time at which the version was saved.
why | string | | Reason for saving.
who | string | | User who saved the version.
"""
        ),
    ),
    TableColumns(
        "part_counts",
        "",
        "Part counts of the programs.",
        declare_keys(
            """
program | string | | File name of the program.
count | integer | | Parts made.
last | string | UTC | Time of the last part.
"""
        ),
    ),
    TableColumns(
        "runs",
        "",
        "The last run and the last proof of each program.",
        declare_keys(
            """
program | string | | File name of the program.
started | string or null | UTC | Start of the last run.
outcome | string | | How the last run ended; empty while it runs.
cycles | integer | | Complete cycles.
best | number or null | s | Shortest cycle time.
latest | number or null | s | Latest cycle time.
proved | string or null | UTC | Time of the last proof.
proof | string | | Result of the last proof.
planned | number or null | s | Cycle time that the last proof calculated.
"""
        ),
    ),
    TableColumns(
        "events",
        "",
        "The event log. `events.csv` has the columns `at` to `who`, in this order, the newest event last.",
        (
            *_ID,
            *declare_row_keys("", EventRow, EVENT_COLUMNS),
            *declare_keys("message | string | | Template and values of the text, JSON."),
        ),
    ),
    TableColumns(
        "tool_offsets",
        "",
        "Tool offsets of a lathe. The export contains them in inches in `offsets.toml`, "
        "together with the secondary and zero offsets and the tool shapes.",
        (*_NUMBER, *_columns(ToolOffsetRow, TOOL_OFFSET_COLUMNS, {"nose_radius": "r"})),
    ),
    TableColumns(
        "secondary_offsets",
        "",
        "Secondary offsets, D1 to D32.",
        (*_NUMBER, *_columns(SecondaryOffsetRow, SECONDARY_OFFSET_COLUMNS)),
    ),
    TableColumns(
        "zero_offsets",
        "",
        "Zero offsets G54 to G59.",
        (*declare_keys("code | integer | | 54 to 59."), *_columns(ZeroOffsetRow, ZERO_OFFSET_COLUMNS)),
    ),
    TableColumns(
        "tool_shapes",
        "",
        "Shapes of the tools of a lathe.",
        (*_NUMBER, *_columns(ToolShapeRow, TOOL_SHAPE_COLUMNS, {"insert": "insert_code"})),
    ),
    TableColumns(
        "part_features",
        "features.csv",
        "Features of the parts that are measured.",
        (
            *_columns(FeatureRow, FEATURE_COLUMNS),
            *declare_keys("retired | integer | | 1 if the feature is no longer measured, otherwise 0."),
        ),
    ),
    TableColumns(
        "part_readings",
        "readings.csv",
        "Readings of the features.",
        (
            *_columns(ReadingRow, READING_COLUMNS + OFFSET_CHANGE_COLUMNS)[:-1],
            *declare_keys("void | integer | | 1 if the reading was deleted, otherwise 0."),
        ),
    ),
    TableColumns(
        "part_cycles",
        "cycles.csv",
        "One row for each part that was started.",
        (
            *_ID,
            *_columns(CycleRow, CYCLE_COLUMNS)[:-1],
            *declare_keys("offset_change | integer | | Newest offset change when the cycle started."),
            *_columns(CycleRow, CYCLE_COLUMNS)[-1:],
        ),
    ),
    TableColumns(
        "production_stops",
        "stops.csv",
        "One row for each stop of production.",
        (*_ID, *_columns(ProductionStopRow, STOP_COLUMNS)),
    ),
    TableColumns(
        "tool_lives",
        "tool_lives.csv",
        "Tool life of the tools of a lathe.",
        _columns(ToolLifeRow, TOOL_LIFE_COLUMNS),
    ),
    TableColumns(
        "insert_changes",
        "insert_changes.csv",
        "Changes of inserts and tools.",
        _columns(InsertChange, INSERT_CHANGE_COLUMNS),
    ),
    TableColumns(
        "mill_tool_lives",
        "mill_tool_lives.csv",
        "Use of the tools of a mill.",
        declare_keys(
            """
number | integer | | Number of the tool.
parts | integer | | Parts made since the tool was changed.
seconds | number | s | Time at feed since the tool was changed.
"""
        ),
    ),
    TableColumns(
        "mill_tools",
        "mill_tools.csv",
        "Tools of a mill.",
        (*_NUMBER, *_columns(MillToolRow, MILL_TOOL_COLUMNS)),
    ),
    TableColumns(
        "datum_presets",
        "presets.csv",
        "Presets of a mill.",
        (
            *_NUMBER,
            *_columns(PresetRow, PRESET_COLUMNS)[:4],
            *_columns(PresetRow, PRESET_COLUMNS)[-1:],
            *_columns(PresetRow, PRESET_COLUMNS)[4:-1],
        ),
    ),
    TableColumns(
        "jobs",
        "",
        "The job queue.",
        declare_keys(
            """
id | integer | | Number of the row.
place | integer | | Position in the queue.
program | string | | File name of the program.
wanted | integer | | Parts to make.
made | integer | | Parts that the job had made when the part count of its program was last reset.
base | integer or null | | Part count of the program at which the job started; null if it has not started.
note | string | | Note.
added | string | UTC | Time at which the job was added.
"""
        ),
    ),
)
RUN_FILE_COLUMNS = (
    "program",
    "parts",
    "started",
    "outcome",
    "cycles",
    "best_s",
    "latest_s",
    "proved",
    "proof",
    "planned_s",
)
CORRECTION_FILE_COLUMNS = declare_row_keys("", CorrectionRow, CORRECTION_COLUMNS)
