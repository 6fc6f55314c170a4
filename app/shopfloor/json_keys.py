"""Keys of the JSON file status.json, which the reference manual and the tests use."""

from __future__ import annotations

from core.json_keys import declare_keys

STATUS_KEYS = declare_keys(
    """
machine | string | | Name of the machine.
available | boolean | | Whether TurnDesk receives the state of the machine. If not, most values are null.
execution | string or null | | Execution state as defined by MTConnect: READY, ACTIVE, WAIT, FEED_HOLD,
  INTERRUPTED, STOPPED, PROGRAM_STOPPED, OPTIONAL_STOP or PROGRAM_COMPLETED.
mode | string or null | | Mode as defined by MTConnect: AUTOMATIC, SEMI_AUTOMATIC, MANUAL or
  MANUAL_DATA_INPUT.
estop | string or null | | TRIGGERED or ARMED.
program | string or null | | File name of the loaded program.
parts | integer or null | | Parts made since TurnDesk started.
spindle_load | integer or null | % | Spindle load in steps of five; null if the drive does not report it.
interrupted | object or null | | The interrupted job; null if no job was interrupted.
interrupted.line | integer | | Line at which the job was interrupted.
interrupted.tool | integer | | Tool in use.
interrupted.part | integer | | Number of the part.
interrupted.at | string | UTC | Time of the interruption.
alarms | list | | Active alarms and the hold or stop that is active.
alarms[].of | string | | Condition of MTConnect to which the alarm belongs, such as Xservo or system.
alarms[].level | string | | FAULT or WARNING.
alarms[].code | string | | Number of the alarm as text, or `interrupted`.
alarms[].text | string | | Text and cause of the alarm.
alarms[].number | integer or null | | Number in the alarm catalog.
alarms[].cause | string | | Cause.
alarms[].remedy | string | | What the operator must do.
alarms[].line | integer or null | | Line of the program.
"""
)
FILE_KEYS = (
    *declare_keys(
        """
updated | string | UTC | Time at which the file was written.
since | string | UTC | Time at which `execution` last changed.
"""
    ),
    *STATUS_KEYS,
)
