"""Coefficient laws of links, coolants and their circuits."""
