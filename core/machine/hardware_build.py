"""Read values to frozen hardware; only for files without a finding."""

from __future__ import annotations

from core.machine import hardware_rules
from core.machine.can_addresses import sdo_address
from core.machine.hardware_model import (
    AnalogModel,
    CanNode,
    CanopenModel,
    DncModel,
    EncoderModel,
    GrblhalModel,
    Hardware,
    HomeModel,
    MtconnectModel,
    SimFault,
    SimModel,
    VfdModel,
)
from core.machine.hardware_tables import HardwareReading
from core.table_schema import Values


def hardware_of(reading: HardwareReading, axes: tuple[str, ...], outputs: list[str]) -> Hardware:
    """Everything about wires in the model's units."""
    values, tables = reading.values, reading.tables
    return Hardware(
        feeder=values.flag("machine.feeder"),
        spindle_driver=values.text("spindle.driver"),
        canopen=_canopen(reading) if "canopen" in tables else None,
        vfd=_vfd(values) if "spindle.vfd" in tables else None,
        encoder=_encoder(values) if hardware_rules.ENCODER in tables else None,
        grblhal=_grblhal(reading) if "grblhal" in tables else None,
        dnc=_dnc(values) if "dnc" in tables else None,
        mtconnect=_mtconnect(values) if "mtconnect" in tables else None,
        sim=_sim(reading),
        analog={name: _analog(values, name) for name in reading.analog},
        homes={name: _home(values, name) for name in axes if values.has(f"axis.{name}.home.order")},
        refresh={
            name: values.number(f"io.out.{name}.refresh_ms")
            for name in outputs
            if values.number(f"io.out.{name}.refresh_ms") > 0.0
        },
    )


def _int(values: Values, path: str) -> int:
    return int(values.number(path))


def _canopen(reading: HardwareReading) -> CanopenModel:
    values = reading.values
    return CanopenModel(
        interface=values.text("canopen.interface"),
        channel=values.text("canopen.channel"),
        bitrate=_int(values, "canopen.bitrate"),
        sync=values.number("canopen.sync_ms"),
        host_id=_int(values, "canopen.host_id"),
        heartbeat=values.number("canopen.heartbeat_ms"),
        mode=values.text("canopen.mode"),
        experimental=values.flag("canopen.experimental"),
        record=values.number("canopen.record_ms"),
        nodes=tuple(_node(reading, name) for name in reading.nodes),
    )


def _node(reading: HardwareReading, name: str) -> CanNode:
    values, path = reading.values, f"canopen.nodes.{name}"
    profile = _int(values, f"{path}.profile")
    shared = reading.sdo.get("all", []) if profile == 402 else []
    return CanNode(
        name=name,
        id=_int(values, f"{path}.id"),
        profile=profile,
        eds=values.text(f"{path}.eds"),
        counts_per_rev=_int(values, f"{path}.counts_per_rev"),
        sdo=(*shared, *reading.sdo.get(name, [])),
    )


def _vfd(values: Values) -> VfdModel:
    path = "spindle.vfd"
    return VfdModel(
        family=values.text(f"{path}.family"),
        port=values.text(f"{path}.port"),
        baud=_int(values, f"{path}.baud"),
        parity=values.text(f"{path}.parity"),
        stop=_int(values, f"{path}.stop"),
        id=_int(values, f"{path}.id"),
        comm_loss=values.number(f"{path}.comm_loss_s"),
        hz_per_rpm=values.number(f"{path}.hz_per_rpm"),
        disagree=values.number(f"{path}.disagree_pct"),
    )


def _encoder(values: Values) -> EncoderModel:
    path = hardware_rules.ENCODER
    index, sub = sdo_address(values.text(f"{path}.object") or hardware_rules.POSITION) or (0, 0)
    return EncoderModel(values.text(f"{path}.node"), index, sub, _int(values, f"{path}.counts_per_rev"))


def _grblhal(reading: HardwareReading) -> GrblhalModel:
    values = reading.values
    return GrblhalModel(
        port=values.text("grblhal.port"),
        baud=_int(values, "grblhal.baud"),
        x_mode=values.text("grblhal.x_mode"),
        settings=dict(reading.settings),
    )


def _dnc(values: Values) -> DncModel:
    return DncModel(
        port=values.text("dnc.port"),
        baud=_int(values, "dnc.baud"),
        bits=_int(values, "dnc.bits"),
        parity=values.text("dnc.parity"),
        stop=_int(values, "dnc.stop"),
        flow=values.text("dnc.flow"),
        wrap=values.text("dnc.wrap"),
        eol=values.text("dnc.eol"),
        dc_codes=values.flag("dnc.dc_codes"),
        wait=values.flag("dnc.wait"),
        leader=_int(values, "dnc.leader"),
    )


def _mtconnect(values: Values) -> MtconnectModel:
    return MtconnectModel(
        enabled=values.flag("mtconnect.enabled"),
        bind=values.text("mtconnect.bind"),
        port=_int(values, "mtconnect.port"),
        heartbeat=values.number("mtconnect.heartbeat_ms"),
        device=values.text("mtconnect.device"),
    )


def _sim(reading: HardwareReading) -> SimModel:
    values = reading.values
    return SimModel(
        seed=_int(values, "sim.seed"),
        realtime=values.flag("sim.realtime"),
        faults=tuple(
            SimFault(
                at=values.number(f"{path}.at"),
                what=values.text(f"{path}.what"),
                axis=values.text(f"{path}.axis"),
                value=values.number(f"{path}.value"),
                seconds=values.number(f"{path}.seconds"),
                text=values.text(f"{path}.text"),
            )
            for path in reading.faults
        ),
    )


def _analog(values: Values, name: str) -> AnalogModel:
    path = f"io.analog.{name}"
    low, high = values.pair(f"{path}.range")
    return AnalogModel(
        name,
        values.text(f"{path}.at"),
        low,
        high,
        values.text(f"{path}.switch"),
        _int(values, f"{path}.counts_per_click"),
    )


def _home(values: Values, axis: str) -> HomeModel:
    path = f"axis.{axis}.home"
    has = values.has
    return HomeModel(
        method=_int(values, f"{path}.method") if has(f"{path}.method") else 0,
        latch=values.number(f"{path}.latch") if has(f"{path}.latch") else 0.0,
        offset=values.number(f"{path}.offset") if has(f"{path}.offset") else 0.0,
    )
