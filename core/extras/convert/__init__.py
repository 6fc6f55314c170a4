"""Conversion of turning programs from other controls to OmniTurn programs."""
