"""Production data of tools: tool life by parts and by cutting time."""
