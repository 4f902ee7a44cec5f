"""Families of machines: each turns its parameters into named prismatic parts."""
