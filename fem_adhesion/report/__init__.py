"""One page that a reviewer can be sent, and the command `report`."""
