"""What holds for one contact given in SI: theories, predictions, verdict, and the command `assess`."""
