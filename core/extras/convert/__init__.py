"""Conversion of turning programs for other controls to OmniTurn."""
