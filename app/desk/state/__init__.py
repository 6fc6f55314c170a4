"""What the desk shares with its pages, the window and the composition: one class for each subject. No Qt."""
