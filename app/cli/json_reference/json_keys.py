"""Descriptions of the keys in commands' JSON output, for the reference page and its tests."""

from __future__ import annotations

from app.cli.json_reference.offsets_keys import OFFSETS_HISTORY_OUTPUT, OFFSETS_SHOW_OUTPUT
from app.compose.optional_features import extras, insert_items_after
from core.json_keys import JsonOutput, declare_keys, declare_row_keys, prefix_keys
from core.records.record import Channel

DIAGNOSTIC_KEYS = declare_keys(
    """
line | integer | | Line of the program; 0 if the finding has no line.
column | integer | | Column from 1; 0 if the finding has no line.
severity | string | | error, warning or note.
code | string | | Code of the finding; for a Klartext error, the message name of the control.
message | string | | What is wrong, in one sentence.
args | object | | Values of the message by name.
args.* | string or number | | One value of the message.
hint | string | | The remedy; empty if not available.
check | string or null | | ID of the check of the part, see checks.md; null for other findings.
n | integer or null | | Elementary block; null if the finding has none.
count | integer | | How often the finding occurs.
assumed | list | | Values that TurnDesk assumed for this finding.
silenced | string or null | | Reason why the finding is only a note; null if it is not silenced.
"""
)
_COMPARE = (
    *declare_keys(
        """
offsets | string | | The offsets file of --compare.
features | list | | Features of the two parts.
features[].kind | string | | diameter, bore, shoulder or another kind of feature.
features[].reach | list | length | Where the feature begins and ends: Z for a diameter or bore, otherwise
  radius.
features[].here | number or null | length | Size with the current offsets; null if the part does not have
  the feature.
features[].there | number or null | length | Size with the other offsets; null if the part does not have
  the feature.
features[].difference | number or null | length | there − here; null if only one part has the feature.
differing | integer | | Number of features that differ.
largest | number | length | Largest difference.
removed_volume | list | length³ | Removed volume with the current and the other offsets; null if it is not
  known.
cycle_time_s | list | s | Cycle time with the current and the other offsets.
cutting_time_s | list | s | Cutting time with the current and the other offsets.
rapid_time_s | list | s | Rapid time with the current and the other offsets.
gone | list | | Findings that do not occur with the other offsets, with the keys of `diagnostics`.
added | list | | Findings that occur only with the other offsets, with the keys of `diagnostics`.
"""
    ),
    *prefix_keys("gone[].", DIAGNOSTIC_KEYS),
    *prefix_keys("added[].", DIAGNOSTIC_KEYS),
)
PROVE_OUTPUT = JsonOutput(
    "prove FILE… --json",
    "One object for each program, one per line. For a folder, the output contains one "
    "object for each program, in the order of the names. `stock` is null on a mill, or "
    "if the stock is not known; `compare` exists only with --compare.",
    (
        *declare_keys(
            """
file | string | | The file name as entered in the command; with a folder or --jobs, the name of the program.
dialect | string | | omniturn, klartext or sinumerik.
units | string | | Unit of the program: inch or mm. Lengths in this object follow the language, not this unit.
blocks | integer | | Blocks of the program.
elementary | integer | | Elementary blocks.
diagnostics | list | | Findings.
"""
        ),
        *prefix_keys("diagnostics[].", DIAGNOSTIC_KEYS),
        *declare_keys(
            """
silenced | integer | | Number of findings that are silenced.
cycle_time_s | number | s | Cycle time, without stops for the operator.
cutting_time_s | number | s | Time at feed.
rapid_time_s | number | s | Time at rapid.
dwell_time_s | number | s | Time of dwells.
wait_time_s | number | s | Time in which the program waits for the spindle, the collet or an exact stop.
stops | integer | | How often a cycle waits for the operator.
cutting_length | number | length | Length of the path at feed.
rapid_length | number | length | Length of the path at rapid.
corner_tolerance | number | length | `corner_tolerance` of the machine file.
tools | list | | Tools that the program uses, sorted: numbers, or names as strings.
limits | object | | Lowest and highest values in the program: program positions on a lathe, machine
    positions on a mill.
limits.x | list | length | Lowest and highest X; a radius on a lathe.
limits.y | list | mm | Mill: lowest and highest Y.
limits.z | list | length | Lowest and highest Z.
limits.a | list | deg | Mill with this axis: lowest and highest A.
limits.b | list | deg | Mill with this axis: lowest and highest B.
limits.c | list | deg | Lowest and highest C; a mill has the key only with this axis.
limits.rpm | list | rpm | Lowest and highest spindle speed.
limits.feed_ipm | list | in/min | Lathe: lowest and highest feed.
limits.feed_mm_min | list | mm/min | Mill: lowest and highest feed.
ways | object | | Paths through the program, which depend on inputs and block delete.
ways.proved | integer | | Paths that were proved.
ways.left | integer | | Paths that were not proved.
ways.cycle_time_s | list | s | Shortest and longest cycle time of the proved paths.
stock | object or null | | The stock, before and after machining.
stock.given | string or null | | The stock as specified, such as `bar:1.0`; null if TurnDesk assumed it.
stock.outside | list | length | Points [z, r] of the outside of the stock.
stock.volume | number | length³ | Volume of the stock.
stock.removed_volume | number | length³ | Volume that is removed.
stock.left_volume | number | length³ | Volume that remains.
stock.profile | list | length | Points [z, r] of the finished outside.
stock.bore | list or null | length | Points [z, r] of the finished bore; null without a bore.
stock.min_wall | number or null | length | Smallest wall thickness; null without a bore.
stock.milled | boolean | | Whether live tools cut the part.
stock.pieces | list | length³ | Volumes of the pieces that are parted off.
stock.assumed | list | | Assumptions of TurnDesk, as sentences.
stock.unchecked | list | | Items that were not checked, as sentences.
final | object | | Position after the program; empty on a mill if not available.
final.x | number | length | X: on a lathe a radius in the program frame, on a mill in the working plane.
final.y | number | mm | Mill: Y in the working plane.
final.z | number | length | Z in the program frame or the working plane.
final.mx | number | mm | Mill: machine position X.
final.my | number | mm | Mill: machine position Y.
final.mz | number | mm | Mill: machine position Z.
final.a | number or null | deg | Mill: A; null if the machine does not have the axis.
final.b | number or null | deg | Mill: B; null if the machine does not have the axis.
final.c | number or null | deg | C; on a mill null if the machine does not have the axis.
compare | object | | The part with the offsets of --compare.
"""
        ),
        *prefix_keys("compare.", _COMPARE),
    ),
)
_BLOCK = declare_keys(
    """
n | integer | | Elementary block, counted from 1 in the order of execution.
line | integer | | Line of the program, from 1.
source | string | | Text of that line.
text | string | | The elementary block as the screen shows it.
kind | string | | rapid, feed, arc, thread, rotate, dwell, plane-line, plane-arc, plane or action.
"""
)
_TIME_KEYS = declare_keys(
    """
t0 | number | s | Start of the block, counted from the start of the program.
t1 | number | s | End of the block.
"""
)
EXPAND_OMNITURN_OUTPUT = JsonOutput(
    "expand FILE --json, OmniTurn",
    "One object for each elementary block, one per line, in the order of execution. Keys "
    "that do not apply are null. Lengths are in inches, even for metric programs.",
    (
        *_BLOCK,
        *declare_keys(
            """
x | number | in | End point in the program frame, a radius.
z | number | in | End point in the program frame.
c | number | deg | End angle of C.
mx | number | in | End point in machine positions, a radius.
mz | number | in | End point in machine positions.
cx | number or null | in | Center of an arc, a radius.
cz | number or null | in | Center of an arc.
dir | string or null | | Direction of an arc: cw or ccw, seen with X+ down and Z+ to the right.
px | number or null | in | Plane switching: end point in the frame of the virtual mill.
py | number or null | in | Plane switching: end point in the frame of the virtual mill.
pz | number or null | in | Plane switching: end point in the frame of the virtual mill; on the side of the
  part, a
  diameter.
pcx | number or null | in | Plane switching: center of an arc.
pcy | number or null | in | Plane switching: center of an arc.
feed | number or null | in/min or in/rev | Feed; for a rapid move, the rapid rate.
feed_mode | string or null | | ipm or ipr.
rpm | number | rpm | Commanded spindle speed at the end of the block; negative with M04.
css | number or null | ft/min | Constant surface speed.
"""
        ),
        *_TIME_KEYS,
    ),
)
EXPAND_SINUMERIK_OUTPUT = JsonOutput(
    "expand FILE --json, SINUMERIK",
    "One object for each elementary block, as for the other languages, in millimeters.",
    (
        *_BLOCK,
        *declare_keys(
            """
units | string | | mm.
x | number | mm | End point in X as programmed: a diameter with DIAMON.
z | number | mm | End point in the program frame.
c | number | deg | Angle of C in the workpiece system.
mx | number | mm | End point in machine positions, a radius.
mz | number | mm | End point in machine positions.
mc | number | deg | Angle of C in the machine system.
dc | number | deg | Signed travel of C in the block.
cx | number or null | mm | Center of an arc, as a radius or diameter like `x`.
cz | number or null | mm | Center of an arc.
dir | string or null | | Direction of an arc: cw or ccw.
feed | number or null | feed_mode | Feed; for a rapid move, the speed along the path.
feed_mode | string or null | | mm/min, mm/rev, deg/min or deg/rev.
rpm | number | rpm | Commanded spindle speed at the end of the block; negative with M4.
css | number or null | m/min | Constant surface speed.
"""
        ),
        *_TIME_KEYS,
    ),
)
EXPAND_KLARTEXT_OUTPUT = JsonOutput(
    "expand FILE --json, Klartext",
    "One object for each elementary block, as for the other languages, in millimeters. "
    "Blocks without a position do not have the position keys; only PLANE blocks have the "
    "keys from `frame` to `q122`.",
    (
        *_BLOCK,
        *declare_keys(
            """
units | string | | mm.
x | number | mm | End point in the working plane.
y | number | mm | End point in the working plane.
z | number | mm | End point in the working plane.
mx | number | mm | Machine position after the block.
my | number | mm | Machine position after the block.
mz | number | mm | Machine position after the block.
a | number or null | deg | A after the block; null if the machine does not have the axis.
b | number or null | deg | B after the block; null if the machine does not have the axis.
c | number or null | deg | C after the block; null if the machine does not have the axis.
feed | number or null | feed_mode | Speed along the path; for a rapid move, the speed that the slowest axis
    allows.
feed_mode | string or null | | mm/min, mm/rev, deg/min or deg/rev.
rpm | number | rpm | Commanded spindle speed at the end of the block.
"""
        ),
        *_TIME_KEYS,
        *declare_keys(
            """
frame | list | | Matrix of the working plane, 3 rows of 3 numbers.
datum | list | mm | Origin of the working plane in machine positions.
q120 | number | deg | Target of A, as in Q120.
q121 | number | deg | Target of B, as in Q121.
q122 | number | deg | Target of C, as in Q122.
"""
        ),
    ),
)
TRACE_OUTPUT = JsonOutput(
    "trace FILE --out CSV --json",
    "One object. The CSV file has the columns `t`, the axes of the machine, "
    "`spindle_deg` and `line`. Each row is one setpoint in machine positions, with X as "
    "a radius. The rows are `dt` apart in time.",
    (
        *declare_keys(
            """
file | string | | The program.
out | string or null | | The CSV file; null if the program has errors and no file was written.
dt | number | s | Time from row to row.
cycle_time_s | number | s | Cycle time.
diagnostics | list | | Findings, with the keys of `prove`.
"""
        ),
        *prefix_keys("diagnostics[].", DIAGNOSTIC_KEYS),
    ),
)
RUN_OUTPUT = JsonOutput(
    "run FILE --headless --json",
    "One object, on the last line.",
    declare_keys(
        """
state | string | | complete, refused, alarm, hold or waiting.
final | object | | Position after the run; on a mill empty if the run was refused before the start.
final.x | number | length | Lathe: X in the program frame, a radius. Mill: X in the working plane.
final.z | number | length | Z in the program frame or the working plane.
final.c | number | deg | C; on a mill only if it has the axis.
final.y | number | mm | Mill: Y in the working plane.
final.mx | number | mm | Mill: machine position X. The keys without the prefix `m` are missing if the run is
    not complete.
final.my | number | mm | Mill: machine position Y.
final.mz | number | mm | Mill: machine position Z.
final.a | number | deg | Mill with this axis: A.
final.b | number | deg | Mill with this axis: B.
elapsed_s | number | s | Time of the run.
alarms | list | | Active alarms.
alarms[].number | integer | | Number in the alarm catalog.
alarms[].code | string | | Code of the alarm.
alarms[].text | string | | Text of the alarm.
alarms[].cause | string | | Cause.
alarms[].remedy | string | | What to do.
alarms[].line | integer | | Line of the program; 0 if not available.
underruns | integer | | How often the computer was too late to supply setpoints.
max_following_error | number | length | Largest following error of X and Z.
events | string | | Path of the log of this run; empty if the run was refused before the start.
"""
    ),
)
MACHINE_CHECK_OUTPUT = JsonOutput(
    "machine check FILE --json",
    "One object. If the file has errors, only `file`, `errors` and `ports` exist.",
    declare_keys(
        """
file | string | | The machine file.
machine | string | | Name of the machine.
backend | string | | `machine.backend`.
errors | list | | Errors in the file.
errors[].path | string | | Key of the machine file.
errors[].value | string | | Value in the file; empty if it is missing.
errors[].expected | string | | What is expected instead.
changes | list | | Differences from the file that was accepted last.
changes[].path | string | | Key of the machine file.
changes[].old | string | | Value in the accepted file; — if it did not have the key.
changes[].new | string | | Value now; — if the file does not have the key.
ports | list | | Nodes, drives, inputs, outputs and other connections.
ports[].name | string | | What was checked.
ports[].at | string | | Where it is connected.
ports[].state | string | | State, such as ok, on, off, not checked, no answer, missing, wrong or fault.
ports[].detail | string | | Details; may be empty.
ports[].verdict | string | | ok, FAIL, or not checked if no hardware reports the value.
rights | list | | Rights that the computer grants the process of the control.
rights[].name | string | | Name of the right.
rights[].granted | string | | What was granted.
rights[].missing | string | | Consequence and remedy; empty if nothing is missing.
warnings | list | | Warnings, as sentences.
trouble | list | | Failures, as sentences; if there are any, the exit status is 1.
"""
    ),
)
MACHINE_HAL_OUTPUT = JsonOutput(
    "machine hal FILE --json",
    "One object.",
    declare_keys(
        """
file | string | | The machine file.
board | string | | `board.kind`.
out | string or null | | File of --out.
hal | string | | Text of the HAL file.
beside | object | | Further files, such as the XML file of EtherCAT.
beside.* | string | | Text of the file, by its name.
wires | list | | The wiring table.
wires[].place | string | | Terminal of the board; empty for a signal without one.
wires[].pin | string | | HAL pin.
wires[].signal | string | | HAL signal.
wires[].names | list | | Keys of the machine file.
measure | list | | Values that must be measured on the machine, as sentences.
"""
    ),
)
WHERE_OUTPUT = JsonOutput(
    "where --json",
    "One object. A place may not exist yet.",
    declare_keys(
        """
data_folder | string | | Folder of all data of this user.
store | string | | File of the store.
programs | string | | Folder of the user's programs.
logs | string | | Folder of the logs and crash files.
backups | string | | Folder of the daily backups.
scope_records | string | | Folder of the scope records.
posts | string | | Folder of the post-processors for CAM programs.
documents | string | | Folder of the documentation site. A clone does not contain it.
machine_file | string | | The machine file that is used.
code | string | | Main file of the installed package.
"""
    ),
)
ALARMS_OUTPUT = JsonOutput(
    "alarms [NUMBER…] --json",
    "A list with one object for each alarm.",
    prefix_keys(
        "[].",
        declare_keys(
            """
number | integer | | Number of the alarm.
code | string | | Code of the alarm, as in logs.
kind | string | | alarm with drives off, alarm, hold, stop or notice.
text | string | | Text on the screen.
causes | list | | Likely causes.
remedy | string | | What to do.
"""
        ),
    ),
)


STORE_VERIFY_OUTPUT = JsonOutput(
    "store verify --json",
    "One object.",
    declare_keys(
        """
store | string | | Path of the store.
problems | list | | Damage to the store, as sentences; if there is any, the exit status is 1.
"""
    ),
)
SCOPE_OUTPUT = JsonOutput(
    "scope FILE --json",
    "One object.",
    (
        *declare_keys(
            """
file | string | | The record.
csv | string or null | | File of --csv.
started | number | s | Start of the record, in seconds since 1970-01-01 UTC.
seconds | number | s | Length of the record.
samples | integer | | Number of samples.
rate | number | 1/s | Samples per second during motion.
about | object | | Facts about the record, such as `machine` and `program`.
about.* | string | | One fact.
channels | list | | Recorded channels.
"""
        ),
        *prefix_keys(
            "channels[].",
            declare_row_keys(
                "",
                Channel,
                """
name | | Name of the channel.
unit | | Unit of its values; empty if it has none.
logic | | Whether the channel is a logic signal with the values 1 (on) and 0 (off).
""",
            ),
        ),
        *declare_keys(
            """
channels[].min | number or null | unit | Smallest value; null if not available.
channels[].max | number or null | unit | Largest value; null if not available.
"""
        ),
    ),
)
_OWN_OUTPUTS = (
    *(
        PROVE_OUTPUT,
        EXPAND_OMNITURN_OUTPUT,
        EXPAND_SINUMERIK_OUTPUT,
        EXPAND_KLARTEXT_OUTPUT,
        TRACE_OUTPUT,
        RUN_OUTPUT,
        MACHINE_CHECK_OUTPUT,
        MACHINE_HAL_OUTPUT,
    ),
    *(
        ALARMS_OUTPUT,
        WHERE_OUTPUT,
        OFFSETS_SHOW_OUTPUT,
        OFFSETS_HISTORY_OUTPUT,
        STORE_VERIFY_OUTPUT,
        SCOPE_OUTPUT,
    ),
)
ALL_OUTPUTS = tuple(
    insert_items_after(
        _OWN_OUTPUTS,
        lambda output: output.command,
        [
            (each, after)
            for extra in extras().values()
            for after, outputs in extra.list_json_outputs().items()
            for each in outputs
        ],
    )
)
