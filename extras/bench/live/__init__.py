"""A bench that steers itself to the answer: rows in, set points out, odds in between."""
