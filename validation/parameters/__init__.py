"""What a fit may move: the model's parameters, and what its formulas get wrong."""
