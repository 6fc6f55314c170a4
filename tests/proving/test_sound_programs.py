"""Sound programs as shops write them, with odd but right habits: no false alarm without a word more."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.proof_report import PartReport

PROGRAMS = {
    "a spindle switched by hand, and no G00": """G90G94F300G72
T1
X1.2Z.1
Z.01
F5X-.03
F300Z.1
X.9
F6Z-.75
F10X1.1
F300Z.1
X.75
F6Z-.4
X.85Z-.45
X1.1
F300Z.1
X.7
F4Z0
X.75Z-.025
Z-.4
X.85Z-.45
X.9Z-.75
F10X1.1
F300Z2
T2(CUTOFF)
X1.2Z1
Z-.75
F2X-.02
F300X1.2
Z2
M30
""",
    "drilled, bored, grooved inside": """G90G94F300G73
M03S1200
T1(CENTER DRILL)
X0Z.5
Z.05
G95F.003Z-.12
G94F300Z.5
T2(.375 DRILL)
X0Z.05
G95
G83Z-.8K.2F.005R.05C.02L300
G94F300Z.5
T3(BORING BAR)
X.21Z.05
G95F.004Z-.7
X.19
G94F300Z.05
X.25
G95F.002Z0
X.235Z-.015
Z-.7
X.19
G94F300Z.5
T4(GROOVE ID)
X.2Z.1
Z-.5
G95F.001X.26
G04F.5
X.2
G94F300Z.5
M30
""",
    "contours, a left-hand tool behind a shoulder, a thread, a knurl": """G90G94F300G72
M03S2000
T1(RH TURN)
X.55Z.05
X.5Z.02
G95F.004Z-1
X.52
G94F300Z.02
X.45
G95F.004Z-.6
G02X.49Z-.62R.02
X.52
G94F300Z.02
G95F.002X.3Z.02
Z0
X.4
G03X.44Z-.02R.02
Z-.6
X.5
X.52Z-.61
G94F300X.7
Z.5
T3(LH TURN)
X.7Z-.3
X.46
G95F.002X.42
Z-.2
X.46
G94F300X.7
Z1
T4(THREAD)
X.5Z.2
X.44
G33X.39Z-.5I.01K.05C
G94F300Z1
T5(KNURL)
X.8Z-.7
G95F.01X.495
G04F1
Z-.9
X.8
G94F300Z1
M30
""",
    "a tool behind the axis, spindle backwards": """G90G94F300G72
M04S2000
T7(REAR TURNING)
X-.6Z.05
G95F.003Z0
X.03
G94F300Z.05
X-.4
G95F.004Z-.5
X-.55
G94F300Z1
X0
M05
M30
""",
    "a spring pass over the finished diameter, and a slow retract": """G90G94F300G72
M03S1500
T1
X1.1Z.05
X.8
G95F.004Z-.6
X1.1
G94F300Z.05
X.8
G95F.002Z-.6
F.01X1.2
Z.3
G94F300Z1
M30
""",
    "bar pulled by a gripper with the collet open": """G90G94F300G72
M03S1500
T1(TURN)
X.6Z.05
X.4
G95F.004Z-.5
X.55
G94F300X1Z.5
T2(CUTOFF)
X.7Z-.6
G95F.002X-.02
G94F300X.7
Z.5
T6(BAR PULLER)
X0Z.5
M05
Z-.9F50
M13
Z.05F30
M12
G94F300Z1
M30
""",
}


def part_of(text: str) -> PartReport:
    machine = load_machine(None)
    setup = create_power_up_setup(
        machine, tool_offsets={n: ToolOffset(12.7, -76.2) for n in range(1, 9)}, secondary_offsets={}
    )
    report, part = prove_program_and_part(ProgramSource("SOUND", text), setup, machine, PartSettings())
    assert part is not None
    assert report.errors == ()
    return part


@pytest.mark.parametrize("name", PROGRAMS)
def test_sound_program_gives_no_finding_and_removes_material(name: str) -> None:
    part = part_of(PROGRAMS[name])
    assert part.findings == ()
    assert part.removed_volume_mm3 > 100.0


def test_sound_programs_produce_expected_part_profiles() -> None:
    first = part_of(PROGRAMS["a spindle switched by hand, and no G00"])
    assert len(first.parted_pieces) == 1
    bored = part_of(PROGRAMS["drilled, bored, grooved inside"]).last_piece
    assert bored is not None
    assert bored.bore_profile is not None
    assert max(r for _, r in bored.bore_profile) == pytest.approx(0.26 * 25.4, abs=0.01)
    assert min(r for _, r in bored.bore_profile) == 0.0  # where the drill has not been
    rear = part_of(PROGRAMS["a tool behind the axis, spindle backwards"]).last_piece
    assert rear is not None
    assert rear.outside_profile[1][1] == pytest.approx(0.2 * 25.4, abs=0.01)
