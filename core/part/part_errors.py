"""Geometry that cannot be cut or machined."""

from __future__ import annotations

from core.coded_error import CodedError


class PartError(CodedError, ValueError):
    """Points, edges or outlines from which no part, cut or tool can be computed."""
