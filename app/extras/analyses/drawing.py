"""What an analysis draws: lines and marks, in units inside."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """``soft`` (n, 2) is what was asked for, then a curve each; ``below`` are curves of a second plot.

    ``equal``: both axes are lengths, in one scale. ``marks`` are places with their words. ``names`` say what
    is shown upwards, upwards in the second plot, and across; {unit} in them is that of a length.
    """

    soft: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    curves: tuple[FloatArray, ...] = ()
    below: tuple[FloatArray, ...] = ()
    marks: tuple[tuple[float, float, str], ...] = ()
    equal: bool = True
    lengths: bool = True  # what is shown upwards
    lengths_below: bool = False  # what the second plot shows upwards is a length too
    names: tuple[str, str, str] = ("", "", "")

    @property
    def downwards(self) -> bool:
        """Whether the upright axis grows downwards: X of a lathe does, as the operator sees the slide."""
        return self.equal and self.names[0].startswith("X")
