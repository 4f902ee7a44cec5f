"""The stage of pictures in space: surfaces cut open, camera, scale, labels."""
