"""Files of force curves: columns of text, and the files of instruments."""
