"""The sections of the office page, of MQTT and of the web hook in the reference of JSON."""

from __future__ import annotations

from app.extras.office.office_json_keys import EVENT, OFFICE
from core.json_key import Output

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
    Output("The office web page and the MQTT state message", _OFFICE, OFFICE),
    Output("MQTT and webhook events", _EVENT, EVENT),
)
