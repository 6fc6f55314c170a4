"""Settings of the screen that the operator chooses, such as language, theme, units and readout."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from enum import StrEnum

from app.desk.persistence import Persistence
from core.message import Message
from core.store.store_errors import StoreError

KEY = "screen"


class Units(StrEnum):
    """The unit of displayed values. The operator always enters values in the unit of the control."""

    PROGRAM = "AS THE PROGRAM"
    INCH = "INCH"
    METRIC = "MM"

    def metric(self, control: bool) -> bool:
        """Return whether displayed values are metric.

        ``control`` is whether the control uses metric units now.
        """
        return control if self is Units.PROGRAM else self is Units.METRIC


@dataclass(frozen=True, slots=True)
class Settings:
    """All screen settings, with default values for a new machine."""

    theme: str = "dark"
    language: str = "en"
    units: str = Units.PROGRAM.value
    readout: str = "POSITION"
    dock: bool = True
    full_screen: bool = False
    first_job: bool = False  # The card of the first job is shown.
    latched: bool = False  # The palm buttons may be pressed one after the other on a simulated machine.


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


_PASSING = frozenset({"readout"})  # Settings that change many times per shift and are not logged.


@dataclass(slots=True)
class SettingsBook:
    """The settings in force. A stored value that is not a valid choice is ignored."""

    persistence: Persistence = field(default_factory=Persistence)
    now: Settings = field(init=False)

    def __post_init__(self) -> None:
        self.reload()

    def reload(self) -> None:
        """Read the stored settings. If the store cannot be read, the defaults apply."""
        try:
            kept = self.persistence.read_setting(KEY)
        except StoreError:
            kept = None
        found = kept if isinstance(kept, dict) else {}
        names = {field.name for field in fields(Settings)}
        self.now = Settings(**{n: v for n, v in found.items() if n in names and _is_choice(n, v)})

    def choose(self, name: str, value: object) -> None:
        """Apply a setting and save it. Raises ValueError for an invalid value, StoreError if saving fails."""
        if not _is_choice(name, value):
            raise ValueError(f"{name} cannot be {value!r}")
        before, self.now = getattr(self.now, name), replace(self.now, **{name: value})  # type: ignore[arg-type]
        self.persistence.save_setting(KEY, asdict(self.now))
        if name not in _PASSING:
            self.persistence.note_change(
                Message("screen: {name} {before} → {value}", name=name, before=before, value=value)
            )

    def following(self, name: str) -> object:
        """Return the choice after the present one, in a cycle."""
        choices = CHOICES[name]
        return choices[(choices.index(getattr(self.now, name)) + 1) % len(choices)]

    @property
    def units(self) -> Units:
        """The unit of displayed values."""
        return Units(self.now.units)


def _is_choice(name: str, value: object) -> bool:
    return any(value == choice and type(value) is type(choice) for choice in CHOICES.get(name, ()))
