"""What a script works with: an open case, a machine that was built, the effects that are known."""
