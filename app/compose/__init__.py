"""The one place where rooms and drivers are put together. Each module is imported only by who needs it."""
