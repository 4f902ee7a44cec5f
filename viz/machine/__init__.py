"""Pictures of the machine: field, parts, network, missing heat, arrows, animation."""
