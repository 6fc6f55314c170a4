"""Keys of status.json, of the office page, of MQTT and of the web hook, for the reference and its tests."""

from __future__ import annotations

from core.json_key import keys

STATUS = keys(
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
FILE = (
    *keys(
        """
updated | string | UTC | Time at which the file was written.
since | string | UTC | Time at which `execution` last changed.
"""
    ),
    *STATUS,
)
OFFICE = (
    *keys("updated | string | UTC | Time of the status."),
    *STATUS,
    *keys(
        """
state | string | | State as shown on the screen, such as RUNNING, FEED HOLD or ALARM; CONTROL SILENT
  if TurnDesk does not receive the state of the machine.
waiting_for | string | | What a cycle waits for; empty if it does not wait.
line | integer or null | | Line that is being executed.
made | integer or null | | Part count of the program.
time_left | number or null | s | Remaining time of the cycle; null if it is not known.
cycle_elapsed | number or null | s | Time since the start of the cycle.
last_cycle | number or null | s | Time of the last complete cycle.
stop | string | | Why the machine is stopped, as shown on the screen.
next_barred | string | | Why no further part can start, such as a used-up tool life; empty if a part can
    start.
stops | list | | The newest stops of production, at most six, the newest first.
stops[].at | string | UTC | Start of the stop.
stops[].reason | string | | Reason for the stop.
stops[].seconds | integer | s | Length of the stop.
"""
    ),
)
EVENT = (
    *keys(
        """
event | string | | part, stop, alarm, tool-life or runs.
text | string | | The event in one sentence.
"""
    ),
    *OFFICE,
)
