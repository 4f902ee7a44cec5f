"""Recordings for the rerun viewer."""
