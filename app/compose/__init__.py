"""Assembly of TurnDesk from its packages and drivers. Each module is loaded only when TurnDesk needs it."""
