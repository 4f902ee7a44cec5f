"""The pages in docs/papers: every figure and table of the two papers that can be computed, ours beside theirs.

python -m scripts.papers            # pages and pictures
"""
