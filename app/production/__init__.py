"""What is counted and kept while parts are made: tool lives, cycles and stops."""
