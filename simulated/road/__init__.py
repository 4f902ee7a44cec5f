"""Drive, readings and files of the road test."""
