"""From a mesh to matrices: elements, parts, contacts, surfaces, streams, materials."""
