"""Klartext cycles: holes, pockets, contours and point patterns."""
