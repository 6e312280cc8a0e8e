"""Maps of heights: arrays, files, other packages, preparation."""
