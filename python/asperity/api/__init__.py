"""Contact problems as users pose them."""
