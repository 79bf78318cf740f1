"""What a digit costs: methods beside each other, page, and the command `speed`."""
