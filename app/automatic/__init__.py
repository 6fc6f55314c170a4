"""The Automatic page; its model is the desk itself."""
