"""The machine as it looks: rounded, ribbed and bolted shapes that only pictures use. Nothing here is ever meshed."""
