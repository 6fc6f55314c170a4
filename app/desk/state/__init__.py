"""State that TurnDesk shares with its pages, the window and the composition, without Qt."""
