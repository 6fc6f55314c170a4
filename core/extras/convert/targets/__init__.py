"""Programs for other controls: the steps of an OmniTurn program, the writers and the proof."""
