"""The generator's own physics: conduction, films, losses, materials, the air stream."""
