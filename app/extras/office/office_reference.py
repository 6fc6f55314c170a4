"""JSON keys of the office page, MQTT and webhook, for the reference documentation and its tests."""

from __future__ import annotations

from app.shopfloor.json_keys import STATUS_KEYS
from core.json_keys import JsonOutput, declare_keys

STATUS_PAGE_KEYS = (
    *declare_keys("updated | string | UTC | Time of the status."),
    *STATUS_KEYS,
    *declare_keys(
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
EVENT_KEYS = (
    *declare_keys(
        """
event | string | | part, stop, alarm, tool-life or runs.
text | string | | The event in one sentence.
"""
    ),
    *STATUS_PAGE_KEYS,
)


_OFFICE = """
The office page, which [status_page] configures, serves this object at `/status.json`. MQTT
publishes it as a retained message at `TOPIC/state`. `TOPIC/available` is `online` or `offline`,
without JSON.
"""
_EVENT = """
MQTT publishes each event at `TOPIC/event` as a message that is not retained. The web hook receives
the same object by POST, with `Content-Type: application/json`.
"""
OUTPUTS = (
    JsonOutput("The office web page and the MQTT state message", _OFFICE, STATUS_PAGE_KEYS),
    JsonOutput("MQTT and webhook events", _EVENT, EVENT_KEYS),
)
