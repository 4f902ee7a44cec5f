"""Electrical machines and vehicles as drives: what currents, speeds and losses a cycle asks for."""
