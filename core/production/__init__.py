"""What tools have cut: their lives by parts and by minutes."""
