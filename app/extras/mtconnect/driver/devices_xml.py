"""The device model for the reference agent: its ``Devices.xml``, with the items that the adapter tells.

Millimetres are sent and ``nativeUnits`` is left out, so the agent multiplies nothing.
"""

from __future__ import annotations

import re
import uuid
from datetime import datetime
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from app.extras.mtconnect.driver.mtconnect_items import Component, DataItem
from app.extras.mtconnect.driver.shdr_lines import stamp
from core.message import Message
from core.ports import DriverError

VERSION = "2.2"
NAMESPACE = f"urn:mtconnect.org:MTConnectDevices:{VERSION}"
_SCHEMA = f"{NAMESPACE} http://schemas.mtconnect.org/schemas/MTConnectDevices_{VERSION}.xsd"
_XSI = "http://www.w3.org/2001/XMLSchema-instance"
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_.-]*")


def devices_xml(device: Component, described: str, at: datetime) -> str:
    """The whole document. Raises DriverError for a device whose name no agent would take.

    ``described`` is for people. The uuid comes from the device's name, so it is the same at every call.
    """
    if not _NAME.fullmatch(device.name):
        raise DriverError(
            Message(
                "[mtconnect] device = {device}: use only letters, digits, ., - and _, and begin with "
                "a letter",
                device=f"{device.name!r}",
            )
        )
    root = Element("MTConnectDevices", {"xmlns": NAMESPACE, "xmlns:xsi": _XSI, "xsi:schemaLocation": _SCHEMA})
    root.append(_header(at))
    inner = _element(device, device.name, SubElement(root, "Devices"))
    inner.set("uuid", str(uuid.uuid5(uuid.NAMESPACE_URL, f"urn:turndesk:{device.name}")))
    description = Element("Description")
    description.text = described
    inner.insert(0, description)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _header(at: datetime) -> Element:
    """An agent fills it with its own figures; the schema wants it to be there."""
    return Element(
        "Header",
        {
            "creationTime": stamp(at),
            "sender": "turndesk",
            "instanceId": "1",
            "version": f"{VERSION}.0.0",
            "assetBufferSize": "1024",
            "assetCount": "0",
            "bufferSize": "131072",
            "deviceModelChangeTime": stamp(at),
        },
    )


def _element(component: Component, device: str, parent: Element) -> Element:
    """A component with its items, then its parts, as the schema orders them.

    Identifiers begin with the device's name: one agent may have many machines, and no two may be alike.
    """
    named = {"id": f"{device}_{component.kind}_{component.name}", "name": component.name}
    element = SubElement(parent, component.kind, named)
    if component.items:
        items = SubElement(element, "DataItems")
        for item in component.items:
            SubElement(items, "DataItem", _attributes(item, device))
    if component.parts:
        parts = SubElement(element, "Components")
        for part in component.parts:
            _element(part, device, parts)
    return element


def _attributes(item: DataItem, device: str) -> dict[str, str]:
    told = {
        "category": item.category.value,
        "id": f"{device}_{item.key}",
        "name": item.key,
        "type": item.type,
        "subType": item.sub_type,
        "units": item.units,
        "coordinateSystem": item.frame,
    }
    return {name: text for name, text in told.items() if text}
