"""State that TurnDesk shares with its pages, its window and ``app.compose``. It does not use Qt."""
