"""Settings of the screen that the operator has chosen: language, theme, units, readout, station."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from enum import StrEnum

from app.desk.persistence import Persistence
from core.message import Message
from core.store.store_errors import StoreError

KEY = "screen"


class Units(StrEnum):
    """The unit of the figures that are shown; what is typed is always in that of the control."""

    PROGRAM = "AS THE PROGRAM"
    INCH = "INCH"
    METRIC = "MM"

    def metric(self, control: bool) -> bool:
        """Whether figures are metric; ``control``: whether the control is, now."""
        return control if self is Units.PROGRAM else self is Units.METRIC


@dataclass(frozen=True, slots=True)
class Settings:
    """All choices; every one has a value that works on a new machine."""

    theme: str = "dark"
    language: str = "en"
    units: str = Units.PROGRAM.value
    readout: str = "POSITION"
    dock: bool = True
    full_screen: bool = False
    first_job: bool = False  # its card is shown
    latched: bool = False  # palms one after the other, where everything is simulated


CHOICES: Mapping[str, tuple[object, ...]] = {
    "theme": ("dark", "light"),
    "language": ("en", "es"),
    "units": tuple(unit.value for unit in Units),
    "readout": ("POSITION", "DISTANCE TO GO", "FROM HOME"),
    "dock": (True, False),
    "full_screen": (True, False),
    "latched": (True, False),
    "first_job": (True, False),
}


_PASSING = frozenset({"readout"})  # turned on by a key many times a shift: no line of the log


@dataclass(slots=True)
class SettingsBook:
    """The choices in force. A value that is kept but no choice any more is forgotten, not obeyed."""

    persistence: Persistence = field(default_factory=Persistence)
    now: Settings = field(init=False)

    def __post_init__(self) -> None:
        self.reload()

    def reload(self) -> None:
        """Read what is kept; where that cannot be read the screen still has settings."""
        try:
            kept = self.persistence.read_setting(KEY)
        except StoreError:
            kept = None
        found = kept if isinstance(kept, dict) else {}
        names = {field.name for field in fields(Settings)}
        self.now = Settings(**{n: v for n, v in found.items() if n in names and _is_choice(n, v)})

    def choose(self, name: str, value: object) -> None:
        """Take a choice and keep it. Raises ValueError for what is none, StoreError when it is not kept."""
        if not _is_choice(name, value):
            raise ValueError(f"{name} cannot be {value!r}")
        before, self.now = getattr(self.now, name), replace(self.now, **{name: value})  # type: ignore[arg-type]
        self.persistence.save_setting(KEY, asdict(self.now))
        if name not in _PASSING:
            self.persistence.note_change(
                Message("screen: {name} {before} → {value}", name=name, before=before, value=value)
            )

    def following(self, name: str) -> object:
        """The choice after the present one."""
        choices = CHOICES[name]
        return choices[(choices.index(getattr(self.now, name)) + 1) % len(choices)]

    @property
    def units(self) -> Units:
        """The unit of the figures."""
        return Units(self.now.units)


def _is_choice(name: str, value: object) -> bool:
    return any(value == choice and type(value) is type(choice) for choice in CHOICES.get(name, ()))
