"""Control process, which is started with ``python -m app.compose.control.control_process FD ZERO FOLDER``.

The machine is read from stdin. FD is the socket to the screen that started the process. Another screen
finds the control at the socket in the data folder FOLDER.
"""

from __future__ import annotations

import gc
import pickle
import signal
import sys
import threading
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path

from app.compose.control.control_messages import ControlFailedMessage, is_same_user
from app.compose.control.control_server import CHECK_INTERVAL_S, ControlServer
from app.compose.control.control_slot import ControlSlot, ScreenListener
from app.compose.control.process_rights_check import acquire_rights
from app.compose.runs.error_log import ErrorLog
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.wakeups import RealClock

_SWITCH_INTERVAL_S = 0.001  # s after which a thread that reads a program yields to the executor
LOG_FILE_NAME = "control.log"


def main(arguments: list[str]) -> int:
    """Run the machine until the screen closes it, or until no screen reconnects in time."""
    first, clock, folder = Connection(int(arguments[0])), RealClock(float(arguments[1])), Path(arguments[2])
    machine = pickle.load(sys.stdin.buffer)  # from the parent process, over a pipe that no other process has
    assert isinstance(machine, Machine)
    sys.setswitchinterval(_SWITCH_INTERVAL_S)
    log = ErrorLog(LOG_FILE_NAME)
    rights = acquire_rights()
    try:
        place = ControlSlot(folder)
        server = ControlServer(machine, clock, folder, rights, place.drivers_lock)
    except DriverError as error:
        with suppress(OSError):
            first.send(ControlFailedMessage(error.fault if isinstance(error.fault, str) else str(error)))
        log.close()
        return 1
    gc.collect()
    gc.freeze()  # modules and other permanent objects need not be scanned again
    for number in (signal.SIGTERM, signal.SIGINT):  # sent when the computer shuts down
        signal.signal(number, lambda *_: server.closing_event.set())
    server.start()
    _serve_connection(server, first)  # before another screen can find the control
    listener = place.create_listener()
    if listener is not None:
        threading.Thread(target=_serve_screens, args=(server, listener), name="screens", daemon=True).start()
    while not server.closing_event.wait(CHECK_INTERVAL_S):
        server.check_screen_response()
    server.close()
    if listener is not None:
        listener.close()
    place.close()
    log.close()
    return 0


def _serve_screens(server: ControlServer, listener: ScreenListener) -> None:
    """Accept the connections of screens to the control, one after another."""
    while not server.closing_event.is_set():
        with suppress(OSError, EOFError):
            connection = listener.accept_screen()
            if is_same_user(connection):
                _serve_connection(server, connection)
            else:
                connection.close()


def _serve_connection(server: ControlServer, connection: Connection) -> None:
    """Serve a screen in a new thread. A second screen thus receives a response without waiting."""
    threading.Thread(target=server.serve_screen, args=(connection,), name="screen", daemon=True).start()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
