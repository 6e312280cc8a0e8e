"""What all rooms use: types, units, messages, warnings, progress."""
