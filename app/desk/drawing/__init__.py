"""Programs as polylines: seen from above, on the face of the part, on its unrolled side."""
