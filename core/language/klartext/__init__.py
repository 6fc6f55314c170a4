"""The Klartext dialect as text: lines, their words, and what is wrong with them."""

from core.language.klartext.klartext_line import read_line

__all__ = ["read_line"]
