"""A tool setter on the simulated machine: its input is on while the tip of a tool stands in its stylus."""

from __future__ import annotations

from drivers.simulators.plant_config import SimSetter


class ToolSetter:
    """``made`` is its input; where the slides were when that came on is kept, as a fast drive would."""

    def __init__(self, config: SimSetter) -> None:
        self._config = config
        self.made = False
        self.deepest = 0.0  # mm that a tip has gone into the stylus at most
        self.kept: tuple[float, tuple[float, ...]] | None = None

    def look(self, t: float, x: float, z: float, readings: tuple[float, ...]) -> None:
        """The slides stand at ``x z``; their encoders say ``readings``."""
        config = self._config
        half = config.width / 2.0
        depths = [
            half - max(abs(x - tip_x - config.x), abs(z - tip_z - config.z)) for tip_x, tip_z in config.tips
        ]
        depth = max(depths, default=-1.0)
        if depth > 0.0 and not self.made and self.kept is None:
            self.kept = (t, readings)
        self.made = depth > 0.0
        self.deepest = max(self.deepest, depth)
