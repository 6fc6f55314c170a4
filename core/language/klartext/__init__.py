"""Parser of the Klartext dialect, with lines, words and syntax errors."""

from core.language.klartext.klartext_line import parse_line

__all__ = ["parse_line"]
