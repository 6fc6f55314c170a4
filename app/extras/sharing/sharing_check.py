"""Row of ``turndesk machine check`` for the shared location."""

from __future__ import annotations

from app.compose.backends.backend_entry import Answers, Row
from app.extras.sharing.sharing_desk import place_of
from core.extras.sharing.shared_place import SharingError
from core.extras.sharing.sharing_table import SharingTable
from core.machine.machine_model import Machine


def check_sharing(machine: Machine, answers: Answers) -> None:
    """Add a row that shows whether the shared location responds and is set up."""
    table = machine.hardware.table(SharingTable)
    if table is None:
        return
    place = place_of(table)
    try:
        found = place.look({})
    except SharingError as error:
        answers.rows.append(Row("sharing", place.name, "no answer", str(error)))
        answers.trouble.append(str(error))
    else:
        desks = ", ".join(sorted(each.desk for each in found.desks)) or ("no control shares programs yet")
        answers.rows.append(Row("sharing", place.name, "ok", desks))
