"""Result of one analysis of a record, with all values that the drawing and the table need."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
import numpy.typing as npt

from app.extras.analyses.axis_response import AxisResponse
from app.extras.analyses.drive_test_results import DriveTestResults
from app.extras.analyses.spindle_response import SpindleResponse
from core.extras.analyses.path_error import BallBarResult, PathError, WorstDeviation
from core.extras.analyses.thread_passes import ThreadAnalysis

FloatArray = npt.NDArray[np.float64]


class AnalysisKind(Enum):
    """Type of analysis, such as path error or ball-bar plot."""

    PATH = "PATH ERROR"
    THREAD = "THREAD"
    BALL_BAR = "BALL BAR"
    AXIS_RESPONSE = "RESPONSE"
    SPINDLE_RESPONSE = "SPINDLE"


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """Result of an analysis. Only the field for the type of the analysis is set.

    If there is no result, ``unavailable_reason`` is the reason.
    """

    analysis_kind: AnalysisKind
    unavailable_reason: str = ""
    path_error: PathError | None = None
    worst_deviations: tuple[WorstDeviation, ...] = ()
    thread_analysis: ThreadAnalysis | None = None
    pass_speeds_rpm: tuple[FloatArray, ...] = ()  # of the passes, rpm
    ball_bar_result: BallBarResult | None = None
    axis_response: AxisResponse | None = None
    spindle_response: SpindleResponse | None = None
    drive_test_results: DriveTestResults | None = None  # the record is one of a drive test
    selected_arc: tuple[int, int, int] = (0, 0, 0)  # its number, of how many, its line
    max_speed_mm_s: float = 0.0  # of the slide along a thread, mm/s
    axis_names: tuple[str, str] = ("Z", "X")  # that are drawn
    linear_axes: tuple[str, ...] = ("Z", "X")  # of a path: all that it goes in
