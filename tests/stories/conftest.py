"""The stage of a story: a server and a folder of its own; a picture of the screen when it fails."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

import pytest

import resources
from core.store.store import Store
from tests.stories.fork_server import ForkServer
from tests.stories.operator import Operator
from tests.stories.x11 import SIZE, Server, missing, server

FAILURES = Path(__file__).resolve().parents[2] / "story-failures"
INCH = 25.4
Tools = Mapping[int, tuple[float, float]]
_REPORTS = pytest.StashKey[list[pytest.TestReport]]()


@dataclass
class Story:
    """Begins as often as the story switches the computer on."""

    server: Server
    forks: ForkServer
    folder: Path
    operators: list[Operator] = field(default_factory=list)

    @property
    def home(self) -> Path:
        """What the lathe remembers."""
        return self.folder / "home"

    def begins(
        self,
        program: str = "",
        *,
        machine: str = "gt75.toml",
        changes: Mapping[str, str] | None = None,
        tools: Tools | None = None,
        in_real_time: bool = False,
    ) -> Operator:
        """``turndesk`` is switched on.

        ``program`` is the text of a program that is on the desk then, ``machine`` a shipped machine file and
        ``changes`` what is written otherwise in it, ``tools`` the X (radius) and Z of offsets, inches.
        ``in_real_time``: other processes share its clock (``tests.stories.patient_clock``).
        """
        words = ["--machine", str(self._machine(machine, changes or {}))]
        if program:
            path = self.folder / "part.nc"
            path.write_text(program)
            words += ["--program", str(path)]
        for number, (x, z) in (tools or {}).items():
            with Store.open(self.home) as store:
                store.offsets.tool_offsets.change_row(
                    number, "before the story", {"x": x * INCH, "z": z * INCH}
                ).result()
        self.home.mkdir(exist_ok=True)
        operator = Operator(self.server, self.forks, self.home, *words, in_real_time=in_real_time)
        self.operators.append(operator)
        operator.arrives()
        return operator

    def _machine(self, name: str, changes: Mapping[str, str]) -> Path:
        text = resources.read_machine_file(name)
        for old, new in changes.items():
            assert old in text, old
            text = text.replace(old, new, 1)
        path = self.folder / name
        path.write_text(text)
        return path


@pytest.fixture(scope="session")
def forks() -> Iterator[ForkServer]:
    """What starts the processes of all stories."""
    why = missing()
    if why:
        pytest.skip(f"stories need an X server: {why}")
    with closing(ForkServer()) as made:
        yield made


@pytest.fixture
def story(request: pytest.FixtureRequest, forks: ForkServer, tmp_path: Path) -> Iterator[Story]:
    """A story is told with this; its parameter is the size of the screen, in pixels."""
    with server(tmp_path / "x", getattr(request, "param", SIZE)) as display:
        told = Story(display, forks, tmp_path)
        yield told
        if any(report.failed for report in request.node.stash.get(_REPORTS, [])):
            _picture(told, request.node.name)
        for operator in told.operators:
            operator.leaves()


def _picture(told: Story, name: str) -> None:
    told.server.picture(FAILURES / f"{name}.png")
    words = [str(operator.machine) + "\n" + operator.errors for operator in told.operators]
    (FAILURES / f"{name}.txt").write_text("\n".join(words))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Iterator[None]:
    """Remember how a story went, and say where its picture is."""
    report: pytest.TestReport = yield  # type: ignore[assignment]
    item.stash.setdefault(_REPORTS, []).append(report)
    if report.failed and "story" in getattr(item, "fixturenames", ()):
        report.sections.append(("picture of the screen", str(FAILURES / f"{item.name}.png")))
    return report  # type: ignore[return-value]
