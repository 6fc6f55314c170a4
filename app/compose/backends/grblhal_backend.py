"""Backend for a grblHAL controller."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from app.compose.backends.backend_entry import Backend, ConnectedMachine, has_inverter
from app.compose.backends.inverter_backend import add_inverter
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.ports import Clock, DriverError
from drivers.grblhal.grblhal_config import GrblAxis, GrblConfig, GrblInput, GrblOutput
from drivers.grblhal.grblhal_machine import GrblMachine
from drivers.grblhal.grblhal_table import GrblhalTable
from drivers.grblhal.grblhal_transport import parse_tcp_address
from drivers.inverter.inverter_spindle import InverterSpindle
from drivers.simulators.grblhal_connections import PtyConnection, TcpConnection, run_simulator
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.wakeups import RealClock

_WIRED_AXES = frozenset(("X", "Z"))
_HOME_HERE_METHODS = frozenset((35, 37))  # homing methods of CiA 402 that use the present position


def create_grblhal_config(machine: Machine) -> GrblConfig:
    """Return the configuration of the controller.

    Raises DriverError if the machine file is not suitable for grblHAL.
    """
    model = machine.hardware.find_driver_table(GrblhalTable)
    if model is None:
        raise DriverError("{source}: the [grblhal] table is missing", source=machine.source)
    if model.x_mode != "G8":
        raise DriverError(
            "{source}: grblhal.x_mode must be G8, because otherwise a reset would change the meaning of X",
            source=machine.source,
        )
    if machine.hardware.spindle_driver not in {"grblhal", "vfd"}:
        raise DriverError(
            "{source}: with backend grblhal, set spindle.driver to grblhal (the controller "
            "drives the spindle) or vfd (an inverter drives the spindle)",
            source=machine.source,
        )
    return GrblConfig(
        grblhal_table=model,
        axes=tuple(_axis(axis, machine) for axis in machine.axes),
        max_rpm=machine.spindle.max_rpm,
        outputs={name: GrblOutput(out.terminal, out.safe_state) for name, out in machine.outputs.items()},
        inputs={
            name: GrblInput(wired.terminal, wired.is_active_low) for name, wired in machine.inputs.items()
        },
        has_own_spindle=not has_inverter(machine),
    )


def _play_devices(
    machine: Machine,
    should_continue: Callable[[], bool],
    print_line: Callable[[str], None],
    _typed: Callable[[], Iterable[str]],
) -> None:
    """Simulate the controller on the TCP port in the machine file, or on a new pseudoterminal."""
    address = parse_tcp_address(create_grblhal_config(machine).grblhal_table.port)
    end: TcpConnection | PtyConnection = PtyConnection() if address is None else TcpConnection(*address)
    print_line(
        Message(
            "simulated grblHAL for {machine} on {end}; press Ctrl-C to stop",
            machine=machine.name,
            end=end.device_name,
        )
    )
    run_simulator(end, GrblFirmware(RealClock()), should_continue)


def _axis(axis: Axis, machine: Machine) -> GrblAxis:
    home = machine.hardware.homing_models.get(axis.name)
    here = home.offset if home is not None and home.method in _HOME_HERE_METHODS else None
    return GrblAxis(
        axis.name,
        axis.max_speed,
        axis.max_acceleration,
        axis.is_position_absolute,
        axis.name in _WIRED_AXES,
        here,
    )


def _connect_controller(machine: Machine, clock: Clock) -> ConnectedMachine:
    """Connect a controller that plans motion itself. The operator station is on the screen.

    If an inverter drives the spindle and the controller has an encoder, the encoder measures the spindle
    speed.
    """
    controller = GrblMachine(create_grblhal_config(machine), clock)
    ports, close, encoder = controller.ports, controller.close, controller.encoder
    if has_inverter(machine):
        ports, close = add_inverter(
            machine, ports, clock, close, encoder if encoder.has_measured_speed else None
        )
        spindle = ports.spindle
        assert isinstance(spindle, InverterSpindle)
        encoder.get_reported_rpm = lambda: spindle.reported_rpm
    return ConnectedMachine(ports, controller.on_screen_station, None, close)


def _measured_rows(machine: Machine) -> Iterator[str]:
    """Yield the names of the check rows with values that hardware measures.

    These are the rows of the controller, the inputs, and the spindle if it has an encoder. Axis positions
    are only step counts, and the overrides are set on the screen.
    """
    yield "controller"
    if machine.spindle.encoder_ppr:
        yield "spindle"
    yield from (f"input {name}" for name in machine.inputs)


BACKEND = Backend(
    "controller",
    connect=_connect_controller,
    simulate_devices=_play_devices,
    list_measured_row_names=_measured_rows,
)
