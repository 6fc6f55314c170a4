"""Reader of the Klartext dialect: lines, words and syntax errors."""

from core.language.klartext.klartext_line import read_line

__all__ = ["read_line"]
