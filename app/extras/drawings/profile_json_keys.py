"""Keys of the JSON that ``turndesk profile`` prints, for the reference and its tests."""

from __future__ import annotations

from core.json_key import Output, keys

PROFILE = Output(
    "profile DRAWING --json",
    "One object. Lengths are in millimeters.",
    keys(
        """
file | string | | The drawing.
out | string or null | | File of --out.
program | string | | Text of the program.
side | string | | OUTSIDE or BORE.
closed_gap_mm | number | mm | Largest gap in the contour that was closed.
secondary_offset | object or null | | OmniTurn: secondary offset that G41 needs; null without it.
secondary_offset.number | integer | | Number of the secondary offset.
secondary_offset.x | number | mm | X, a radius.
secondary_offset.z | number | mm | Z.
secondary_offset.r | number | mm | Nose radius.
cutting_edge | object | | SINUMERIK: cutting edge that G41 needs; the key is missing without it.
cutting_edge.tool | integer | | Number of the tool.
cutting_edge.edge | integer | | Number of the cutting edge.
cutting_edge.r | number | mm | Nose radius.
cutting_edge.quadrant | integer | | Tip quadrant.
left | list | | Parts of the contour that are not cut.
left[].back_mm | number | mm | Z at which the uncut part ends toward the chuck.
left[].front_mm | number | mm | Z at which the uncut part ends toward the face.
left[].why | string | | Why it is not cut.
worst_mm | number or null | mm | Largest deviation of the part from the drawing; null if it was not compared.
deviations | list | | Deviations from the drawing.
deviations[].back_mm | number | mm | Z of the end of the deviation toward the chuck.
deviations[].front_mm | number | mm | Z of the end of the deviation toward the face.
deviations[].most_mm | number | mm | Largest deviation there.
errors | list | | Errors of the program; the exit status is then 1.
"""
    ),
)
PROFILE_LIST = Output(
    "profile DRAWING --list --json",
    "One object.",
    keys(
        """
file | string | | The drawing.
unit_mm | number or null | mm | Length of one unit of the drawing; null if the drawing does not specify it.
layers | list | | Names of the layers.
axes | list | | Names of the axes.
axis | string | | The axis that is used.
contours | list | | Contours, numbered from 1.
contours[].elements | integer | | Number of lines and arcs.
contours[].length_mm | number | mm | Length.
contours[].diameter_mm | number | mm | Largest diameter.
left_out | object | | Objects of the drawing that are ignored.
left_out.* | integer | | Number, by kind.
"""
    ),
)
OUTPUTS = (PROFILE, PROFILE_LIST)
