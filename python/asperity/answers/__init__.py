"""What solves return: solutions, tables of them, and folders."""
