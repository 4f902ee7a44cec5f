"""Machines with a hidden effect, made by physics that the product does not share, and what a diagnosis says of them."""
