"""JSON keys of ``turndesk parts`` and ``turndesk shift``, for the reference documentation and its tests."""

from __future__ import annotations

from core.extras.quality.control_charts import Capability
from core.extras.quality.production_stops import StopReasonTotal
from core.json_keys import JsonOutput, declare_keys, declare_row_keys, prefix_keys
from core.store import table_keys
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.production.tool_lives import InsertChange, ToolLifeRow
from core.store.store_rows import EventRow

_READING = declare_row_keys("", ReadingRow, table_keys.READING_COLUMNS + table_keys.OFFSET_CHANGE_COLUMNS)
_STOP = declare_row_keys("", ProductionStopRow, table_keys.STOP_COLUMNS)
_LIFE = declare_row_keys("", ToolLifeRow, table_keys.TOOL_LIFE_COLUMNS)
_INSERT = declare_row_keys("", InsertChange, table_keys.INSERT_CHANGE_COLUMNS)
PARTS_OUTPUT = JsonOutput(
    "parts [PROGRAM] --json",
    "One object. Lengths are in millimeters.",
    (
        *declare_keys(
            """
programs | list | | Programs with data.
programs[].program | string | | File name of the program.
programs[].parts | integer | | Part count.
programs[].cycles | list | | Cycles.
"""
        ),
        *prefix_keys("programs[].cycles[].", declare_row_keys("", CycleRow, table_keys.CYCLE_COLUMNS)),
        *declare_keys("programs[].features | list | | Measured features."),
        *prefix_keys("programs[].features[].", declare_row_keys("", FeatureRow, table_keys.FEATURE_COLUMNS)),
        *declare_keys("programs[].features[].readings | list | | Readings."),
        *prefix_keys("programs[].features[].readings[].", _READING),
        *declare_keys(
            "programs[].features[].capability | object or null | | Process capability; null if there are too "
            "few readings."
        ),
        *prefix_keys(
            "programs[].features[].capability.",
            declare_row_keys(
                "",
                Capability,
                """
count | | Number of readings.
mean | mm | Mean.
within | mm | Standard deviation within samples.
cp | | Cp; null if a limit is missing or the readings do not scatter.
cpk | | Cpk; null if the readings do not scatter.
pp | | Pp; null if a limit is missing or the readings do not scatter.
ppk | | Ppk; null if the readings do not scatter.
""",
            ),
        ),
        *declare_keys("programs[].corrections | list | | Changes of wear offsets and secondary offsets."),
        *prefix_keys("programs[].corrections[].", table_keys.CORRECTION_FILE_COLUMNS),
        *declare_keys("stops | list | | Stops of production."),
        *prefix_keys("stops[].", _STOP),
        *declare_keys("tool_lives | list | | Tool life of the tools of a lathe."),
        *prefix_keys("tool_lives[].", _LIFE),
        *declare_keys("insert_changes | list | | Changes of inserts."),
        *prefix_keys("insert_changes[].", _INSERT),
    ),
)
SHIFT_OUTPUT = JsonOutput(
    "shift --json",
    "One object. Lengths are in millimeters; X of offsets is a radius.",
    (
        *declare_keys(
            """
from | string | UTC | Start of the shift.
to | string | UTC | End of the shift.
notes | list | | Missing data, as sentences.
parts | integer | | Parts of all programs.
programs | list | | Programs that ran.
programs[].program | string | | File name of the program.
programs[].parts | integer | | Parts.
programs[].no_part | object | | Cycles without a part, by outcome.
programs[].no_part.* | integer | | Number of cycles.
programs[].cycle_times | list | s | Times of the complete cycles.
planned | number | s | Time in which production was possible.
producing | number | s | Time in which a cycle ran.
stopped | number | s | Time of all stops.
not_recorded | number | s | Time for which no data is stored.
stops | list | | Stops of production.
"""
        ),
        *prefix_keys("stops[].", _STOP),
        *declare_keys("reasons | list | | Stops by reason, the longest total time first."),
        *prefix_keys(
            "reasons[].",
            declare_row_keys(
                "",
                StopReasonTotal,
                """
reason | | Reason for the stops.
times | | Number of stops.
seconds | s | Total time.
share | | Fraction of the time of all stops, 0 to 1.
together | | Cumulative fraction of this reason and all reasons with a longer total time, 0 to 1.
""",
            ),
        ),
        *declare_keys("alarms | list | | Alarms from the event log."),
        *prefix_keys("alarms[].", declare_row_keys("", EventRow, table_keys.EVENT_COLUMNS)),
        *declare_keys("tool_lives | list | | Tool life of the tools."),
        *prefix_keys("tool_lives[].", _LIFE),
        *declare_keys("insert_changes | list | | Changes of inserts."),
        *prefix_keys("insert_changes[].", _INSERT),
        *declare_keys(
            """
offset_changes | list | | Changes of offsets.
offset_changes[].at | string | UTC | Time of the change.
offset_changes[].kind | string | | Table: tool, secondary, zero, shape, mill tool or preset.
offset_changes[].number | integer | | Number of the offset.
offset_changes[].why | string | | Reason for the change.
offset_changes[].who | string | | User or TurnDesk function that made the change.
offset_changes[].old | object or null | mm | Row before the change; null if it was not set.
offset_changes[].old.* | string or number or boolean | mm | One value of the row.
offset_changes[].new | object or null | mm | Row after the change; null if it was cleared.
offset_changes[].new.* | string or number or boolean | mm | One value of the row.
readings | integer | | Number of readings.
out_of_tolerance | list | | Readings out of tolerance.
out_of_tolerance[].program | string | | File name of the program.
out_of_tolerance[].feature | string | | Name of the feature.
out_of_tolerance[].part | integer | | Number of the part.
out_of_tolerance[].value | number | mm | Measured size.
out_of_tolerance[].at | string | UTC | Time of the reading.
"""
        ),
    ),
)
OUTPUTS = {"offsets history --json": (PARTS_OUTPUT, SHIFT_OUTPUT)}
