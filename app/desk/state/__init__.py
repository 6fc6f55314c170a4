"""State that TurnDesk shares with its pages, the window and the modules of ``app.compose``, without Qt."""
