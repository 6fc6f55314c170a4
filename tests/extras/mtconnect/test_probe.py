"""The device model: what an agent needs to place every key, by the names and units of the standard."""

from __future__ import annotations

from datetime import UTC, datetime
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import pytest

from app.extras.mtconnect.driver.mtconnect_adapter import SCHEMA_NAMESPACE, make_devices_xml
from app.extras.mtconnect.driver.mtconnect_items import MachineLayout, make_machine_items
from core.ports import DriverError
from tests.coded import raises_code
from tests.extras.mtconnect.bench import lathe

AT = datetime(2026, 2, 3, 4, 5, 6, tzinfo=UTC)
# (category, type, sub-type, units) of each key, from the table of the standard's items for this lathe.
WANTED = {
    "avail": ("EVENT", "AVAILABILITY", None, None),
    "estop": ("EVENT", "EMERGENCY_STOP", None, None),
    "mode": ("EVENT", "CONTROLLER_MODE", None, None),
    "execution": ("EVENT", "EXECUTION", None, None),
    "program": ("EVENT", "PROGRAM", None, None),
    "line": ("EVENT", "LINE_NUMBER", "ABSOLUTE", None),
    "block": ("EVENT", "BLOCK", None, None),
    "toolnum": ("EVENT", "TOOL_NUMBER", None, None),
    "pcount": ("EVENT", "PART_COUNT", "ALL", None),
    "Xabs": ("SAMPLE", "POSITION", "ACTUAL", "MILLIMETER"),
    "Zabs": ("SAMPLE", "POSITION", "ACTUAL", "MILLIMETER"),
    "Cabs": ("SAMPLE", "ANGLE", "ACTUAL", "DEGREE"),
    "Srpm": ("SAMPLE", "ROTARY_VELOCITY", "ACTUAL", "REVOLUTION/MINUTE"),
    "Scmd": ("SAMPLE", "ROTARY_VELOCITY", "PROGRAMMED", "REVOLUTION/MINUTE"),
    "Sovr": ("EVENT", "ROTARY_VELOCITY_OVERRIDE", "PROGRAMMED", "PERCENT"),
    "Sload": ("SAMPLE", "LOAD", "ACTUAL", "PERCENT"),
    "Fact": ("SAMPLE", "PATH_FEEDRATE", "ACTUAL", "MILLIMETER/SECOND"),
    "Fovr": ("EVENT", "PATH_FEEDRATE_OVERRIDE", "PROGRAMMED", "PERCENT"),
    "rotmode": ("EVENT", "ROTARY_MODE", None, None),
    "chuck": ("EVENT", "CHUCK_STATE", None, None),
    "chuckil": ("EVENT", "CHUCK_INTERLOCK", None, None),
    "door": ("EVENT", "DOOR_STATE", None, None),
    "endbar": ("EVENT", "END_OF_BAR", None, None),
    "part": ("EVENT", "PART_DETECT", None, None),
    "Xtravel": ("CONDITION", "POSITION", None, None),
    "Ztravel": ("CONDITION", "POSITION", None, None),
    "Xservo": ("CONDITION", "ACTUATOR", None, None),
    "Zservo": ("CONDITION", "ACTUATOR", None, None),
    "Sdrive": ("CONDITION", "ACTUATOR", None, None),
    "comms": ("CONDITION", "COMMUNICATIONS", None, None),
    "logic": ("CONDITION", "LOGIC_PROGRAM", None, None),
    "system": ("CONDITION", "SYSTEM", None, None),
    "motion": ("CONDITION", "MOTION_PROGRAM", None, None),
}


def root(name: str = "GT75") -> Element:
    return ElementTree.fromstring(make_devices_xml(lathe(name), "a lathe", AT))


def elements(top: Element, kind: str) -> list[Element]:
    return list(top.iter(f"{{{SCHEMA_NAMESPACE}}}{kind}"))


def test_items_match_the_mtconnect_standard() -> None:
    items = elements(root(), "DataItem")
    named = {
        item.attrib["name"]: tuple(item.get(key) for key in ("category", "type", "subType", "units"))
        for item in items
    }
    assert named == WANTED
    assert len(items) == len(WANTED)


def test_device_model_declares_no_native_units() -> None:
    text = make_devices_xml(lathe(), "a lathe", AT)
    assert "native" not in text
    frames = {
        item.get("coordinateSystem") for item in elements(root(), "DataItem") if item.get("coordinateSystem")
    }
    assert frames == {"MACHINE"}


def test_components_follow_the_schema_order() -> None:
    device = elements(root(), "Device")[0]
    assert [child.tag.partition("}")[2] for child in device] == ["Description", "DataItems", "Components"]
    path = [child.attrib["name"] for child in elements(root(), "Components")[0]]
    assert path == ["base", "controller", "guard", "auxiliaries"]
    chuck = elements(elements(root(), "Rotary")[0], "Chuck")[0]
    assert [item.attrib["name"] for item in elements(chuck, "DataItem")] == ["chuck", "chuckil"]
    for part in root().iter():
        assert list(part) or part.tag.endswith(("DataItem", "Description", "Header"))  # none is empty


def test_two_lathes_of_one_agent_share_no_identifiers() -> None:
    ids = [
        element.attrib["id"]
        for name in ("GT75-1", "GT75-2")
        for element in root(name).iter()
        if "id" in element.attrib
    ]
    assert len(ids) == len(set(ids)) > 80
    uuids = {elements(root(name), "Device")[0].attrib["uuid"] for name in ("GT75-1", "GT75-2", "GT75-1")}
    assert len(uuids) == 2  # and each keeps its own


def test_header_has_a_creation_time() -> None:
    assert elements(root(), "Header")[0].attrib["creationTime"] == "2026-02-03T04:05:06.000Z"


@pytest.mark.parametrize("name", ["", "GT 75", "75GT", "GT|75", "GT:75", "<GT>", "Drehmaschine Ø"])
def test_device_name_invalid_for_agents_is_rejected(name: str) -> None:
    with raises_code(DriverError, "driver", "[mtconnect] device", repr(name)):
        make_devices_xml(lathe(name), "a lathe", AT)


def test_description_accepts_any_text() -> None:
    text = make_devices_xml(lathe(), 'Tom & "Jerry" <5>', AT)
    assert elements(ElementTree.fromstring(text), "Description")[0].text == 'Tom & "Jerry" <5>'


def test_a_mill_has_its_own_axes_and_no_chuck() -> None:
    mill = make_machine_items(
        MachineLayout(("X", "Y", "Z"), ("A", "C"), "S", is_spindle_positionable=False, has_chuck=False), "AC"
    )
    keys = {item.key for item in mill.iterate_items()}
    assert {"Yabs", "Yservo", "Aabs", "Aservo", "Atravel", "Cabs", "Cservo", "Srpm", "Sdrive"} <= keys
    assert not keys & {"chuck", "chuckil", "Sabs"}
