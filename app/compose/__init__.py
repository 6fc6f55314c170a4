"""Assembly of TurnDesk from its packages and drivers. Each module is loaded only when it is needed."""
