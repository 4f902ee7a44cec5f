"""What the terminal shows: answers, progress, groups of commands."""
