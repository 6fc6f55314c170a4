"""Production data of tools, which is the tool life by parts and by cutting time."""
